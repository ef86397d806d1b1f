#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>

namespace liloc {

/// Of lines that a bad stream repeats one is let through in five seconds. Not thread-safe.
class LineLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// How many were held back since the last one; empty: this one is held back as well.
  [[nodiscard]] std::optional<std::uint64_t> pass(Time now) {
    if (last_ && now - *last_ < std::chrono::seconds(5)) {
      ++held_;
      return std::nullopt;
    }
    last_ = now;
    return std::exchange(held_, 0);
  }

 private:
  std::optional<Time> last_;
  std::uint64_t held_ = 0;
};

}  // namespace liloc
