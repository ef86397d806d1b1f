#pragma once
// Time as it travels: integer nanoseconds since the epoch of the clock that made the stamp.
#include <chrono>
#include <cstdint>

namespace liloc {

using StampNs = std::int64_t;

constexpr double kNsPerSecond = 1e9;  // by definition
constexpr StampNs from_ms(double ms) {
  return static_cast<StampNs>(ms * 1e6);
}
constexpr double to_ms(StampNs duration_ns) {
  return static_cast<double>(duration_ns) * 1e-6;
}
constexpr double to_seconds(StampNs duration_ns) {
  return static_cast<double>(duration_ns) / kNsPerSecond;
}
constexpr StampNs from_seconds(double seconds) {
  return static_cast<StampNs>(seconds * kNsPerSecond);
}

/// This host's clock, which may be set at any time.
[[nodiscard]] inline StampNs wall_clock_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// Measures elapsed time on the steady clock; never compared with a stamp.
class Stopwatch {
 public:
  [[nodiscard]] double elapsed_ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace liloc
