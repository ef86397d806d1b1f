#include "common/registration/fpfh.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <random>

#include "common/registration/neighbors.hpp"

namespace liloc {
namespace {

using Histogram = Eigen::Matrix<float, kFpfhSize, 1>;
constexpr int kBins = 11;

int bin(float value, float low, float span) {
  return std::clamp(static_cast<int>(std::floor(kBins * (value - low) / span)), 0, kBins - 1);
}

/// Adds the three angles of a pair in its Darboux frame; the point whose normal is nearer to the line is the
/// source.
void add_pair(const Eigen::Vector3f& p1, const Eigen::Vector3f& n1, const Eigen::Vector3f& p2,
              const Eigen::Vector3f& n2, Histogram* histogram) {
  Eigen::Vector3f line = p2 - p1;
  const float length = line.norm();
  if (length == 0) return;
  const float angle1 = n1.dot(line) / length, angle2 = n2.dot(line) / length;
  const bool swap = std::abs(angle1) < std::abs(angle2);
  const Eigen::Vector3f& u = swap ? n2 : n1;
  const Eigen::Vector3f& other = swap ? n1 : n2;
  if (swap) line = -line;
  const Eigen::Vector3f v_raw = line.cross(u);
  const float v_length = v_raw.norm();
  if (v_length == 0) return;
  const Eigen::Vector3f v = v_raw / v_length;
  const Eigen::Vector3f w = u.cross(v);
  const auto pi = static_cast<float>(M_PI);
  (*histogram)[bin(std::atan2(w.dot(other), u.dot(other)), -pi, 2 * pi)] += 1;
  (*histogram)[kBins + bin(v.dot(other), -1, 2)] += 1;
  (*histogram)[2 * kBins + bin(swap ? -angle2 : angle1, -1, 2)] += 1;
}

/// The simplified histogram of one point: itself against each neighbour, as per cent.
Histogram simplified(const Cloud& cloud, const RadiusSearch& search, std::uint32_t i) {
  Histogram histogram = Histogram::Zero();
  int pairs = 0;
  search.for_each(cloud.points[i], [&](std::uint32_t j, float) {
    if (j == i) return;
    add_pair(cloud.points[i], cloud.normals[i], cloud.points[j], cloud.normals[j], &histogram);
    ++pairs;
  });
  return pairs > 0 ? Histogram(histogram * (100.0F / static_cast<float>(pairs))) : histogram;
}

void normalize(Eigen::Ref<Histogram> histogram) {
  for (int part = 0; part < 3; ++part) {
    auto bins = histogram.segment<kBins>(part * kBins);
    const float sum = bins.sum();
    if (sum > 0) bins *= 100.0F / sum;
  }
}

}  // namespace

Features fpfh(const Cloud& cloud, const std::vector<std::uint32_t>& index, double radius_m) {
  assert(cloud.has_normals() || index.empty());
  Features features{index, {}};
  features.descriptors.setZero(kFpfhSize, static_cast<Eigen::Index>(index.size()));
  const RadiusSearch search(cloud.points, radius_m);
  std::vector<Histogram> simple(cloud.size());
  std::vector<char> done(cloud.size(), 0);
  for (std::size_t k = 0; k < index.size(); ++k) {
    Histogram weighted = Histogram::Zero();
    search.for_each(cloud.points[index[k]], [&](std::uint32_t j, float squared) {
      if (squared == 0) return;
      if (done[j] == 0) {
        simple[j] = simplified(cloud, search, j);
        done[j] = 1;
      }
      weighted += simple[j] / squared;
    });
    normalize(weighted);
    features.descriptors.col(static_cast<Eigen::Index>(k)) = weighted;
  }
  return features;
}

std::vector<std::uint32_t> sample_indices(std::size_t count, double share, std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  const auto threshold = static_cast<std::uint64_t>(std::clamp(share, 0.0, 1.0) * 4294967296.0);
  std::vector<std::uint32_t> index;
  for (std::uint32_t i = 0; i < count; ++i)
    if ((rng() >> 32) < threshold) index.push_back(i);
  return index;
}

}  // namespace liloc
