#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
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

/// Of one kind of line that strangers can cause: in five seconds one of each source, and of no more than
/// sixteen sources, as a stranger may take on any number of names. Not thread-safe.
class SourceLimit {
 public:
  using Time = LineLimit::Time;

  /// As `LineLimit::pass`.
  [[nodiscard]] std::optional<std::uint64_t> pass(const std::string& source, Time now) {
    if (now - window_ >= std::chrono::seconds(5)) {
      window_ = now;
      heard_.clear();
    }
    if (heard_.size() >= kSources || !heard_.insert(source).second) {
      ++held_;
      return std::nullopt;
    }
    return std::exchange(held_, 0);
  }

 private:
  static constexpr std::size_t kSources = 16;  // by hand: more lines a window bury all others
  Time window_{};
  std::set<std::string> heard_;  ///< in this window
  std::uint64_t held_ = 0;
};

/// The end of a line that others were held back before: " (and 3 like it before)", or nothing.
[[nodiscard]] inline std::string held_back(std::uint64_t count) {
  return count == 0 ? "" : " (and " + std::to_string(count) + " like it before)";
}

}  // namespace liloc
