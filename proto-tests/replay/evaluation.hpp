#pragma once
// Judges the traces of a replay by the ground truth alone.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/recording/recording.hpp"

namespace liloc::replay {

/// How far the poses of a trajectory are from the truth. Empty figures: no pose to judge.
struct TrackScore {
  double coverage = 0;  ///< share of the device's frames that have a pose
  std::optional<double> mean_rot_deg, mean_trans_m, median_rot_deg, median_trans_m;
  std::optional<double> frames_over_10deg_03m;  ///< share of poses off by more than 10 deg or 0.3 m
  bool correct = false;                         ///< mean error within 10 deg and 0.3 m
};

/// How far the covariances told with the online poses are those of their errors.
struct DoubtScore {
  std::size_t poses = 0;
  std::optional<double> nees_mean, nees_median;  ///< 6 and 5.3 where they are right
  std::optional<double> beyond;                  ///< share with a squared distance over 22.5: 1 in 1000
  std::optional<double>
      wrong_untold;  ///< share off by more than 10 deg or 0.3 m whose deviation is not beyond that
};

/// Spots count for `loose` and `strict` where the device cloud overlaps the ceiling clouds by 0.3 at the truth.
struct SpotScore {
  std::size_t n = 0, n_overlap = 0;
  std::optional<double> loose, strict;           ///< share within 10 deg and 0.3 m, 3 deg and 0.1 m
  std::size_t verified = 0, verified_wrong = 0;  ///< wrong: off by more than 10 deg or 0.3 m
  std::optional<double> latency_ms_median, latency_ms_p99;
};

/// The odometry alone, before any global correction.
struct LocalScore {
  double end_pct_of_path = 0, end_rot_deg = 0, path_m = 0;
  std::size_t pairs = 0;  ///< consecutive frames judged
  std::optional<double> ok_3deg_01m, median_trans_m, median_rot_deg, latency_ms_median;
};

struct DeviceScore {
  std::string id;
  std::size_t frames = 0;
  bool has_truth = false;  ///< without it only what needs no truth is filled in
  TrackScore online, trajectory;
  DoubtScore doubt;
  SpotScore spots;
  std::optional<LocalScore> local;
  std::map<std::string, std::size_t> reasons;  ///< of spots.csv
  std::optional<double> first_pose_ms;         ///< recorded time from the first frame to the first global pose
};

/// Reads `folder`/{online,trajectory}.tum, spots.csv, local.csv and doubt.csv. An absent file counts as an
/// empty one. Errors: a file is malformed, or the ground truth cannot be read.
[[nodiscard]] Result<DeviceScore> evaluate(const Recording& recording, const DeviceRecording& device,
                                           const std::filesystem::path& folder);

/// The value below which `share` of the values lie, linear between neighbours; NaN-free input. Empty: none.
[[nodiscard]] std::optional<double> percentile(std::vector<double> values, double share);

}  // namespace liloc::replay
