#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "common/base/log.hpp"

namespace liloc::command {

/// One line of the log as it is printed, without its newline.
using LineFormat = std::function<std::string(log::Level, std::string_view line)>;

/// Where a program's log goes: lines of `least` or above to standard error, each written at once, by `format`,
/// or with time, level and text, in colour on a terminal. Any thread may call it.
[[nodiscard]] log::Sink stderr_sink(const std::string& program, log::Level least, LineFormat format = {});

}  // namespace liloc::command
