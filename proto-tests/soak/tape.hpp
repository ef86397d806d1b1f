#pragma once
// A simulated site's sensors, kept in memory and played to and fro for as long as is wished.
#include <chrono>
#include <functional>
#include <vector>

#include "proto-tests/sim/simulation.hpp"
#include "proto-tests/soak/options.hpp"

namespace liloc::soak {

struct TapeEvent {
  double at_s = 0;
  std::variant<sim::LidarFrame, sim::DeviceFrame, sim::DeviceImu> payload;
};

struct Tape {
  Site site;
  std::vector<DeviceInfo> devices;  ///< ways that somebody goes
  double seconds = 0;
  std::vector<TapeEvent> events;  ///< by rising time from 0 to `seconds`; not empty
};

/// Errors: of the simulation; a stop signal.
[[nodiscard]] Result<Tape> record_tape(const SoakOptions& options, const std::function<void(double)>& progress);

/// One event after another, without end: to the tape's end, back to its beginning, and so on.
class TapePlayer {
 public:
  /// `tape` must outlive it.
  explicit TapePlayer(const Tape& tape) : tape_(tape) {}
  struct Moment {
    double at_s = 0;  ///< since the player began; rises
    const TapeEvent* event = nullptr;
    bool backwards = false;
  };
  [[nodiscard]] Moment next();

 private:
  const Tape& tape_;
  std::size_t played_ = 0;
};

/// What an IMU reads that goes the way backwards: rotations turn about, accelerations stay.
[[nodiscard]] ImuSample reversed(ImuSample sample);

/// The run's time, shared by its processes.
struct RunClock {
  std::chrono::steady_clock::time_point start;
  StampNs start_ns = 0;  ///< the same moment, wall clock

  [[nodiscard]] static RunClock starting_in(double lead_s);
  [[nodiscard]] std::chrono::steady_clock::time_point at(double s) const {
    return start + std::chrono::nanoseconds(from_seconds(s));
  }
  [[nodiscard]] StampNs stamp_ns(double s) const { return start_ns + from_seconds(s); }
  [[nodiscard]] double now_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  /// Until then, or a stop signal.
  void sleep_until(double s) const;
};

}  // namespace liloc::soak
