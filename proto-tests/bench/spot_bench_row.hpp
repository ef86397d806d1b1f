#pragma once
// What one spot brought, against the truth.
#include <string>
#include <vector>

#include "common/protocol/spot.hpp"

namespace liloc::bench {

/// Where a search lost the right answer, if it did.
enum class Miss { none, proposing, refining, judging };

struct Row {
  std::string site;
  std::uint64_t seed = 0;
  bool cold = false;
  double overlap = 0;  ///< true: share of the device's points that the ceiling sees
  double error_deg = 999, error_m = 999;
  Miss miss = Miss::none;                             ///< of a cold one
  double conflict_truth = 0, map_conflict_truth = 0;  ///< what the judge holds against the truth itself
  Vector6d error = Vector6d::Zero();                  ///< [rad; m] in the sensor's true axes
  double nees =
      -1;  ///< squared error over the reported covariance: 6 on average if that is honest; -1: no pose
  double cpu_ms = 0;  ///< of the thread that answered; with one thread a request, what an idle machine takes
  double prepare_ms = 0;  ///< that the room took beside the requests since the spot before, in CPU time
  SpotReply reply;

  [[nodiscard]] bool within(double deg, double m) const { return error_deg <= deg && error_m <= m; }
  [[nodiscard]] bool right() const { return within(10, 0.3); }
};

/// CPU time of this thread so far.
[[nodiscard]] double thread_cpu_ms();

/// `reply` against where the device was.
[[nodiscard]] Row judged(SpotReply reply, const Pose& T_map_sensor_true);

/// Error: the file cannot be written.
[[nodiscard]] Status write_csv(const std::string& path, const std::vector<Row>& rows);

}  // namespace liloc::bench
