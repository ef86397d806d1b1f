#pragma once
#include <deque>
#include <optional>

#include "common/base/stamp.hpp"

namespace liloc {

/// Which frames a small computer leaves out, so that none queues and no more than its share of one core is
/// used: evenly spread ones, as many as the recent frames' cost demands. Not thread-safe.
class FrameBudget {
 public:
  /// `cpu_share` of one core, above 0, up to 1.
  explicit FrameBudget(double cpu_share) : cpu_share_(cpu_share) {}

  /// By the frames' stamps; true when this one is to be processed.
  [[nodiscard]] bool admit(StampNs stamp_ns);
  /// What an admitted frame took.
  void spent(double wall_ms, double cpu_ms);
  /// Shortest time between two processed frames now; 0 until enough is known.
  [[nodiscard]] double interval_ms() const;

 private:
  double cpu_share_;
  std::deque<double> needed_ms_;  ///< of the recent frames
  std::optional<StampNs> last_ns_;
};

/// CPU time of the calling thread so far.
[[nodiscard]] double thread_cpu_ms();

}  // namespace liloc
