#include "common/registration/features/feature_match.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "common/registration/points/simd.hpp"

namespace liloc {
namespace {

constexpr std::size_t kLanes = 8, kGroup = 2 * kLanes;  // descriptors of the block at once
constexpr std::size_t kAtOnce = 4;                      // descriptors asked for at once

using Floats = float __attribute__((vector_size(kLanes * sizeof(float))));
using Ints = std::int32_t __attribute__((vector_size(kLanes * sizeof(float))));

/// Per lane the best of the descriptors that it has seen, for one that is asked for, and the group of that.
struct Best {
  Floats closeness = Floats{} - 1e29F;  // more than what fills up a group
  Ints group = {};
};

LILOC_WIDE void best_of_groups(const float* groups, const float* half_squared, std::size_t count,
                               const float* asked, std::size_t dimensions, Best (*best)[2]) {
  const float *q0 = asked, *q1 = q0 + dimensions, *q2 = q1 + dimensions, *q3 = q2 + dimensions;
  for (std::size_t g = 0; g < count; ++g) {
    const float* block = groups + g * kGroup * dimensions;
    Floats left, right;
    std::memcpy(&left, half_squared + g * kGroup, sizeof left);
    std::memcpy(&right, half_squared + g * kGroup + kLanes, sizeof right);
    Floats a0 = -left, a1 = a0, a2 = a0, a3 = a0, b0 = -right, b1 = b0, b2 = b0, b3 = b0;
    for (std::size_t d = 0; d < dimensions; ++d) {  // eight sums stay in registers
      std::memcpy(&left, block + d * kGroup, sizeof left);
      std::memcpy(&right, block + d * kGroup + kLanes, sizeof right);
      a0 += q0[d] * left, b0 += q0[d] * right;
      a1 += q1[d] * left, b1 += q1[d] * right;
      a2 += q2[d] * left, b2 += q2[d] * right;
      a3 += q3[d] * left, b3 += q3[d] * right;
    }
    const Floats sums[kAtOnce][2] = {{a0, b0}, {a1, b1}, {a2, b2}, {a3, b3}};
    const Ints here = Ints{} + static_cast<std::int32_t>(g);
    for (std::size_t q = 0; q < kAtOnce; ++q)
      for (std::size_t h = 0; h < 2; ++h) {
        const Ints better = sums[q][h] > best[q][h].closeness;
        best[q][h].closeness = better ? sums[q][h] : best[q][h].closeness;
        best[q][h].group = better ? here : best[q][h].group;
      }
  }
}

}  // namespace

FeatureBlock::FeatureBlock(const Features& features, const std::vector<std::uint32_t>& columns)
    : dimensions_(static_cast<std::size_t>(features.descriptors.rows())), columns_(columns) {
  const std::size_t groups = (columns.size() + kGroup - 1) / kGroup;
  groups_.assign(groups * kGroup * dimensions_, 0);
  half_squared_.assign(groups * kGroup, 1e30F);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto descriptor = features.descriptors.col(columns[i]);
    float* group = groups_.data() + i / kGroup * kGroup * dimensions_ + i % kGroup;
    for (std::size_t d = 0; d < dimensions_; ++d) group[d * kGroup] = descriptor[static_cast<Eigen::Index>(d)];
    half_squared_[i] = 0.5F * descriptor.squaredNorm();
  }
}

void FeatureBlock::improve(const Features& features, std::vector<Nearest>* nearest) const {
  assert(static_cast<std::size_t>(features.descriptors.rows()) == dimensions_);
  std::vector<float> asked(kAtOnce * dimensions_);
  for (std::size_t begin = 0; begin < features.size(); begin += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, features.size() - begin);
    std::ranges::fill(asked, 0.0F);
    std::memcpy(asked.data(), features.descriptors.col(static_cast<Eigen::Index>(begin)).data(),
                count * dimensions_ * sizeof(float));
    Best found[kAtOnce][2];
    best_of_groups(groups_.data(), half_squared_.data(), half_squared_.size() / kGroup, asked.data(),
                   dimensions_, found);
    for (std::size_t q = 0; q < count; ++q)
      for (std::size_t lane = 0; lane < kGroup; ++lane) {
        const Best& of_lane = found[q][lane / kLanes];
        const float closeness = of_lane.closeness[lane % kLanes];
        const std::size_t i = static_cast<std::size_t>(of_lane.group[lane % kLanes]) * kGroup + lane;
        Nearest& best = (*nearest)[begin + q];
        if (closeness > best.closeness && i < columns_.size()) best = {columns_[i], closeness};
      }
  }
}

}  // namespace liloc
