#pragma once
#include <chrono>
#include <string>
#include <string_view>

#include "common/base/log.hpp"

namespace liloc {

/// A line of the log as one JSON object, {"time": UTC, "level": ..., "message": ...}, without its line end.
/// What is no UTF-8 is replaced.
[[nodiscard]] std::string json_line(std::chrono::system_clock::time_point at, log::Level level,
                                    std::string_view message);

}  // namespace liloc
