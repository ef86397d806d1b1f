#pragma once
// Pairs of a device's frames, registered by LiLoc, by PCL's GICP and by whoever else reads the files.
#include <filesystem>
#include <optional>
#include <vector>

#include "common/geometry/camera.hpp"
#include "common/geometry/cloud.hpp"

namespace liloc::bench {

/// A frame's cloud, its pose by LiLoc's own odometry and the true one.
struct OdometryFrame {
  Cloud cloud_sensor;  ///< as the odometry uses it, not thinned any further
  Pose T_odom_sensor = Pose::Identity();
  Pose T_map_sensor = Pose::Identity();  ///< truth
};

/// Where the source frame's points lie in the target frame's sensor axes.
struct FramePair {
  std::string name;
  int gap = 0;  ///< frames from the target to the source
  const OdometryFrame *target = nullptr, *source = nullptr;
  Pose T_target_source_guess = Pose::Identity();  ///< the motion of the same number of frames before
  double overlap =
      0;  ///< share of the source's surfels with one of the target's at their place, 0..1, by truth
  [[nodiscard]] Pose truth() const { return target->T_map_sensor.inverse() * source->T_map_sensor; }
};

struct PairResult {
  std::string method;
  int gap = 0;
  double error_m = 0, error_rad = 0, latency_ms = 0;
  double overlap = 0;  ///< of the pair
};

/// Evenly spread pairs, at most `most`. The frames must outlive them.
[[nodiscard]] std::vector<FramePair> choose_pairs(const std::string& name,
                                                  const std::vector<OdometryFrame>& frames, int gap,
                                                  std::size_t most);

/// Preparation of both clouds and registration, on one thread.
[[nodiscard]] PairResult by_liloc(const FramePair& pair, double voxel_m);
/// pcl::GeneralizedIterativeClosestPoint on voxel-filtered clouds.
[[nodiscard]] PairResult by_pcl_gicp(const FramePair& pair, double voxel_m);

/// Writes DIR/<name>.target.ply and .source.ply (binary, float x y z, sensor axes) of each pair, and
/// DIR/pairs.csv:
///   pair,gap,tx,ty,tz,qx,qy,qz,qw     the guess, T_target_source
[[nodiscard]] Status dump_pairs(const std::vector<FramePair>& pairs, const std::filesystem::path& folder);
/// Reads what a peer made of them; rows of pairs that are not here are left out. Columns:
///   pair,method,tx,ty,tz,qx,qy,qz,qw,latency_ms
[[nodiscard]] Result<std::vector<PairResult>> read_peer(const std::vector<FramePair>& pairs,
                                                        const std::filesystem::path& file);

/// A line for each method and gap: shares of all pairs, and of those with overlap over 0.3.
void print_pairs(const std::vector<PairResult>& results);

}  // namespace liloc::bench
