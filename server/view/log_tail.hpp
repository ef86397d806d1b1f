#pragma once
#include <chrono>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/log.hpp"

namespace liloc::view {

struct LogLine {
  std::chrono::system_clock::time_point at;
  log::Level level = log::Level::info;
  std::string text;  ///< at most 300 bytes
};

/// The last lines of the log. Thread-safe.
class LogTail {
 public:
  void add(log::Level level, std::string_view text);
  /// The oldest first.
  [[nodiscard]] std::vector<LogLine> lines() const;
  /// How many were ever added: rises with each.
  [[nodiscard]] std::uint64_t count() const;

 private:
  mutable std::mutex mutex_;
  std::deque<LogLine> lines_;
  std::uint64_t count_ = 0;
};

}  // namespace liloc::view
