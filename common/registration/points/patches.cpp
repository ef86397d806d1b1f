#include "common/registration/points/patches.hpp"

#include "common/geometry/voxel.hpp"

namespace liloc {

std::uint32_t PatchNumbers::of(const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const std::uint64_t side = 2 * static_cast<std::uint64_t>(axis) + (normal[axis] < 0 ? 1 : 0);
  const std::uint64_t key = cell_key(cell_of(point, inverse_)) * 6 + side;
  return numbers_.try_emplace(key, static_cast<std::uint32_t>(numbers_.size())).first->second;
}

void PatchWeights::add(std::uint32_t patch, float weight, float residual, float variance,
                       const Vector6f& jacobian) {
  Sum& sum = sums_[patch];
  sum.weight += weight;
  sum.residual += weight * residual;
  sum.variance += weight * weight * variance;
  sum.jacobian += weight * jacobian;
}

std::vector<float> PatchWeights::weights(const Matrix6f& doubt, const PatchOptions& options) const {
  const auto common = static_cast<float>(options.common_sd_m * options.common_sd_m);
  const auto deviations = static_cast<float>(options.deviations), lasting = static_cast<float>(options.lasting);
  std::vector<float> weights;
  weights.reserve(sums_.size());
  for (const Sum& sum : sums_) {
    if (sum.weight <= 0) {
      weights.push_back(0);
      continue;
    }
    const float mean = sum.residual / sum.weight, noise = sum.variance / (sum.weight * sum.weight);
    const Vector6f jacobian = sum.jacobian / sum.weight;
    const float expected = common + noise + jacobian.dot(doubt * jacobian);
    const float root = 1 / (1 + mean * mean / (deviations * deviations * expected));
    weights.push_back(lasting * noise / (noise + common) * root * root);
  }
  return weights;
}

}  // namespace liloc
