#pragma once
#include "proto-tests/faults/scenario.hpp"

namespace liloc::faults {

/// What a scenario cost. Empty figures: it did not happen.
struct Verdict {
  std::string scenario;
  std::size_t requests = 0, unanswered = 0, replies = 0, verified = 0;
  std::size_t wrong = 0;                          ///< verified, and off by more than 10 degrees or 0.3 m
  std::optional<double> answer_s, late_answer_s;  ///< from a frame to its answer: median, the 95th of a hundred
  std::optional<double> first_s;                  ///< from the first frame to the first verified answer
  std::optional<double> gap_s;                    ///< longest time between two verified answers, or to the end
  /// From the moment when the trouble's cause was over to the first verified answer about a frame taken since.
  std::optional<double> recovery_s;
  bool recovers = false;                          ///< whether that is asked for
  std::size_t frames = 0, located = 0, lost = 0;  ///< since the first verified answer; `lost`: says so
  double worst_m = 0, worst_deg = 0;              ///< of the poses that are not told lost
  double frames_lost = 0;                         ///< share of the frames of the device's link

  /// Nothing wrong was verified, and what was to recover has.
  [[nodiscard]] bool good() const { return wrong == 0 && first_s && (!recovers || recovery_s); }
};

[[nodiscard]] Verdict judge(const Scenario& scenario, const Performed& performed);

/// A row each, several runs of one scenario in one: medians, and in brackets the worst.
[[nodiscard]] std::string to_table(const std::vector<Verdict>& verdicts);
[[nodiscard]] std::string to_json(const std::vector<Verdict>& verdicts);

}  // namespace liloc::faults
