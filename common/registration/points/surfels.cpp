#include "common/registration/points/surfels.hpp"

#include <Eigen/Eigenvalues>
#include <bit>
#include <cmath>

#include "common/geometry/voxel.hpp"

namespace liloc {
namespace {

constexpr std::uint64_t kFree = ~std::uint64_t{0};

/// Sums about the first point of the voxel: single precision loses nothing over 0.1 m.
struct Sums {
  Eigen::Vector3f origin, sum = Eigen::Vector3f::Zero();
  float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  float count = 0;

  void add(const Eigen::Vector3f& p) {
    const Eigen::Vector3f d = p - origin;
    sum += d;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    xz += d.x() * d.z();
    yy += d.y() * d.y();
    yz += d.y() * d.z();
    zz += d.z() * d.z();
    count += 1;
  }

  [[nodiscard]] Surfel surfel() const {
    Surfel s;
    const Eigen::Vector3f m = sum / count;
    s.mean = origin + m;
    s.covariance << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    s.covariance = s.covariance / count - m * m.transpose();
    s.count = count;
    return s;
  }
};

}  // namespace

void orient(Surfel& surfel, const Eigen::Vector3f& towards) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver;
  solver.computeDirect(surfel.covariance);
  const Eigen::Vector3f values = solver.eigenvalues().cwiseMax(1e-9F);
  surfel.normal = solver.eigenvectors().col(0);
  if (surfel.normal.dot(towards - surfel.mean) < 0) surfel.normal = -surfel.normal;
  surfel.flatness = 1.0F - std::sqrt(values[0] / values[1]);
}

std::vector<Surfel> extract_surfels(const Cloud& cloud, const Eigen::Vector3f& sensor_position,
                                    const SurfelOptions& options) {
  const auto inverse = static_cast<float>(1.0 / options.size_m);
  const std::size_t slots = std::bit_ceil(cloud.size() / 2 + 1024);
  const int shift = 64 - std::countr_zero(slots);
  std::vector<std::uint64_t> keys(slots, kFree);
  std::vector<std::uint32_t> index(slots);
  std::vector<Sums> sums;
  sums.reserve(4096);
  std::uint64_t last_key = kFree;
  std::uint32_t last = 0;
  for (const Eigen::Vector3f& p : cloud.points) {
    const std::uint64_t key = cell_key(cell_of(p, inverse));
    if (key != last_key) {  // neighbours in an image row mostly share their voxel
      std::size_t slot = (key * 0x9E3779B97F4A7C15ULL) >> shift;
      while (keys[slot] != key && keys[slot] != kFree) slot = (slot + 1) & (slots - 1);
      if (keys[slot] == kFree) {
        if (sums.size() * 10 > slots * 9) continue;  // a cloud of lone points: the rest would have no direction
        keys[slot] = key;
        index[slot] = static_cast<std::uint32_t>(sums.size());
        sums.emplace_back().origin = p;
      }
      last_key = key;
      last = index[slot];
    }
    sums[last].add(p);
  }
  std::vector<Surfel> surfels;
  surfels.reserve(sums.size());
  for (const Sums& s : sums) {
    if (s.count < static_cast<float>(options.min_points)) continue;
    surfels.push_back(s.surfel());
    orient(surfels.back(), sensor_position);
  }
  return surfels;
}

}  // namespace liloc
