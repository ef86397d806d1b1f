#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/registration/gicp.h>

#include "common/base/stamp.hpp"
#include "proto-tests/bench/pair_bench.hpp"

namespace liloc::bench {
namespace {

using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

PclCloud::Ptr thinned(const Cloud& cloud, double voxel_m) {
  PclCloud::Ptr whole(new PclCloud), thin(new PclCloud);
  for (const Eigen::Vector3f& p : cloud.points) whole->emplace_back(p.x(), p.y(), p.z());
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  const auto leaf = static_cast<float>(voxel_m);
  grid.setLeafSize(leaf, leaf, leaf);
  grid.setInputCloud(whole);
  grid.filter(*thin);
  return thin;
}

}  // namespace

PairResult by_pcl_gicp(const FramePair& pair, double voxel_m) {
  const Stopwatch watch;
  pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> gicp;
  gicp.setInputTarget(thinned(pair.target->cloud_sensor, voxel_m));
  gicp.setInputSource(thinned(pair.source->cloud_sensor, voxel_m));
  gicp.setMaxCorrespondenceDistance(0.3);
  gicp.setMaximumIterations(30);
  PclCloud moved;
  gicp.align(moved, pair.T_target_source_guess.matrix().cast<float>());
  Pose T = Pose::Identity();
  T.matrix() = gicp.getFinalTransformation().cast<double>();
  T = normalized(T);
  return {"PCL GICP",         pair.gap,    distance_m(T, pair.truth()), angle_between_rad(T, pair.truth()),
          watch.elapsed_ms(), pair.overlap};
}

}  // namespace liloc::bench
