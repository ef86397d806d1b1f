#pragma once
// A device's engine without a server over a recording: how far does its odometry drift, and at what cost.
#include <optional>
#include <string>
#include <vector>

#include "client/engine/engine.hpp"
#include "common/recording/recording.hpp"

namespace liloc::bench {

struct DriftOptions {
  LocalMethod local = LocalMethod::cloud;
  bool use_imu = true;
  int every = 1;            ///< frames left out
  double focal_factor = 1;  ///< wrong intrinsics, to see what they do
  double voxel_m = 0.05;
};

struct DriftRun {
  std::vector<FrameResult> frames;
  std::vector<Pose> truth;        ///< T_map_sensor of each
  int requests = 0, motions = 0;  ///< between requests of one segment ...
  int motions_within = 0;         ///< ... that err by less than three of the deviations that the request tells
  double worst_up_deg = -1;
  std::string problem;  ///< the last that the engine complained of
  std::size_t lpc_bytes = 0, extra_bytes = 0;
  double cpu_s = 0;                 ///< of the engine, reading of files left out
  std::optional<double> package_j;  ///< of the whole processor in the time of the run, where the kernel tells

  /// Of the relative pose from frame `i` to frame `j`.
  [[nodiscard]] Pose error(std::size_t i, std::size_t j) const;
};

/// Errors that one wrong pose of the ground truth does not decide, as the end error does; the measures of the
/// TUM benchmark (Sturm et al. 2012).
struct DriftSpread {
  double second_median_m = 0, second_p90_m = 0;  ///< of the relative poses over one second, from every frame on
  double second_median_rad = 0;
  double trajectory_m = 0;  ///< root mean square after the best rigid alignment of the whole trajectory
};
[[nodiscard]] DriftSpread spread_of(const DriftRun& run);

/// Errors: unreadable files, no ground truth.
[[nodiscard]] Result<DriftRun> run_drift(const DeviceRecording& device, const DriftOptions& options);
/// One line; `frames` adds one for each frame. Drift is the judge's figure: error of the relative pose from the
/// first to the last frame, in per cent of the path; DriftSpread follows. "jump": the largest error from one
/// frame to the next that was measured (not marked as a guess).
void print_drift(const std::string& name, const DriftRun& run, bool frames);

/// Why energy cannot be measured on this machine; empty where it can.
[[nodiscard]] std::string energy_obstacle();

}  // namespace liloc::bench
