#include "proto-tests/bench/spot_bench_pair_truth.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "common/geometry/voxel.hpp"
#include "common/registration/points/nearest_grid.hpp"
#include "common/registration/points/normals.hpp"
#include "server/tools/cloud_file.hpp"

namespace liloc::bench {
namespace {

constexpr double kVoxel_m = 0.05;  // as the requests' clouds have

}  // namespace

Result<std::vector<Pair>> read_pairs(const std::string& path) {
  std::ifstream in(path);
  if (!in) return fail("{}: cannot be read; name a folder that holds a gt.log", path);
  std::vector<Pair> pairs;
  int count = 0;
  for (Pair pair; in >> pair.target >> pair.source >> count; pairs.push_back(pair))
    for (int i = 0; i < 16; ++i) in >> pair.T_target_source.matrix()(i / 4, i % 4);
  if (pairs.empty()) return fail("{}: holds no pair; each is `i j n` and four rows of a matrix", path);
  return pairs;
}

Result<const Fragment*> Fragments::at(int index) {
  if (const auto known = read_.find(index); known != read_.end()) return &known->second;
  auto cloud = toolbox::read_cloud_file(fmt::format("{}/cloud_bin_{}.ply", folder_, index));
  if (!cloud) return tl::unexpected(cloud.error());
  Cloud thin = with_normals(voxel_downsample(*cloud, kVoxel_m), Eigen::Vector3f::Zero());
  return &read_.emplace(index, Fragment{std::move(*cloud), std::move(thin)}).first->second;
}

Cloud overlapping(const Cloud& source, const Cloud& target, const Pose& T_target_source) {
  const NearestGrid nearest(target.points, 0.4 * kVoxel_m, 1.2 * kVoxel_m);
  Cloud shared;
  for (const Eigen::Vector3f& p : source.points) {
    const Eigen::Vector3f q = T_target_source.cast<float>() * p;
    const std::int32_t j = nearest.nearest(q);
    if (j != NearestGrid::kNone && (q - target.points[static_cast<std::size_t>(j)]).norm() < kVoxel_m)
      shared.points.push_back(p);
  }
  return shared;
}

double rmse_m(const Cloud& points, const Pose& a, const Pose& b) {
  double sum = 0;
  for (const Eigen::Vector3f& p : points.points)
    sum += (a * p.cast<double>() - b * p.cast<double>()).squaredNorm();
  return points.empty() ? 9 : std::sqrt(sum / static_cast<double>(points.size()));
}

}  // namespace liloc::bench
