#pragma once
#include <deque>
#include <string>

#include "client/odometry/informativeness.hpp"

namespace liloc {

/// Notices depth that cannot be right, by what frames in a row have in common. Not thread-safe.
class InputHealth {
 public:
  /// `residual_m`: of the frame's match with the local map; 0 where there was none. `strain`: how far the IMU's
  /// predictions were off, against what was expected (InertialFilter::strain).
  void note(FrameFault fault, double residual_m, double strain);
  /// The matches so far say nothing about the next ones.
  void forget() { matches_.clear(); }
  /// IMU and depth contradict each other persistently.
  [[nodiscard]] bool contradicted() const;
  /// For people; empty: nothing was noticed.
  [[nodiscard]] std::string problem() const;

 private:
  struct Match {
    double residual_m, strain;
  };
  [[nodiscard]] double median_of(double Match::*figure) const;

  int empty_ = 0;              ///< frames in a row without enough returns
  std::deque<Match> matches_;  ///< the recent ones
};

}  // namespace liloc
