#include <pcl/console/print.h>
#include <pcl/features/fpfh_omp.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/sample_consensus_prerejective.h>
#include <pcl/registration/transformation_estimation_point_to_plane_lls.h>

#include "common/base/stamp.hpp"
#include "common/geometry/pcl.hpp"
#include "proto-tests/bench/spot_bench_peers.hpp"

namespace liloc::bench {
namespace {

using Points = pcl::PointCloud<pcl::PointNormal>;
using Features = pcl::PointCloud<pcl::FPFHSignature33>;
constexpr double kVoxel_m = 0.05;  // as the requests' clouds have

Points::Ptr points_of(const Cloud& cloud) {
  Points::Ptr points(new Points);
  pcl::concatenateFields(*to_pcl(cloud), *normals_to_pcl(cloud), *points);
  return points;
}

Features::Ptr features_of(const Points::Ptr& points, int threads) {
  pcl::FPFHEstimationOMP<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> fpfh;
  fpfh.setNumberOfThreads(static_cast<unsigned>(threads));
  fpfh.setRadiusSearch(5 * kVoxel_m);
  fpfh.setInputCloud(points);
  fpfh.setInputNormals(points);
  Features::Ptr features(new Features);
  fpfh.compute(*features);
  return features;
}

Eigen::Matrix4f by_samples(const Points::Ptr& source, const Features::Ptr& source_features,
                           const Points::Ptr& target, const Features::Ptr& target_features) {
  pcl::SampleConsensusPrerejective<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> ransac;
  ransac.setInputSource(source);
  ransac.setSourceFeatures(source_features);
  ransac.setInputTarget(target);
  ransac.setTargetFeatures(target_features);
  ransac.setMaximumIterations(50000);  // these five as in PCL's own example of aligning objects
  ransac.setNumberOfSamples(3);
  ransac.setCorrespondenceRandomness(5);
  ransac.setSimilarityThreshold(0.9F);
  ransac.setMaxCorrespondenceDistance(1.5 * kVoxel_m);
  ransac.setInlierFraction(0.25F);
  Points aligned;
  ransac.align(aligned);
  return ransac.getFinalTransformation();
}

Eigen::Matrix4f refined(const Points::Ptr& source, const Points::Ptr& target, const Eigen::Matrix4f& guess) {
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
  icp.setInputSource(source);
  icp.setInputTarget(target);
  icp.setMaxCorrespondenceDistance(1.5 * kVoxel_m);
  icp.setMaximumIterations(30);
  Points aligned;
  icp.align(aligned, guess);
  return icp.getFinalTransformation();
}

}  // namespace

PeerAnswer ask_pcl(const PeerProblem& problem, int threads) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // a miss is a row, not a line in between
  const Points::Ptr source = points_of(problem.source), target = points_of(problem.target);
  const Stopwatch of_target;
  const Features::Ptr target_features = features_of(target, threads);
  PeerAnswer answer;
  answer.target_latency_ms = of_target.elapsed_ms();
  const Stopwatch watch;
  const Features::Ptr source_features = features_of(source, threads);
  const Eigen::Matrix4f guess = by_samples(source, source_features, target, target_features);
  answer.T_target_source.matrix() = refined(source, target, guess).cast<double>();
  answer.latency_ms = watch.elapsed_ms();
  return answer;
}

}  // namespace liloc::bench
