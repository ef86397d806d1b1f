#pragma once
// Rooms below the programs speak through this sink; a program decides where the lines go.
#include <fmt/format.h>

#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "common/base/result.hpp"

namespace liloc::log {

enum class Level { debug, info, warning, error };
/// By its name above; the error lists them.
[[nodiscard]] Result<Level> level_from(std::string_view name);
using Sink = std::function<void(Level, std::string_view)>;
/// Replaces the sink (default: nothing is printed). Safe from any thread; the sink must be too. Waits for the
/// calls of the one before, except from inside a sink: what they use may go afterwards.
void set_sink(Sink sink);
/// A line reaches the sink without control characters, whoever wrote what stands in it.
void write(Level level, std::string_view line);

template <class... Args>
void debug(fmt::format_string<Args...> text, Args&&... args) {
  write(Level::debug, fmt::format(text, std::forward<Args>(args)...));
}
template <class... Args>
void info(fmt::format_string<Args...> text, Args&&... args) {
  write(Level::info, fmt::format(text, std::forward<Args>(args)...));
}
template <class... Args>
void warning(fmt::format_string<Args...> text, Args&&... args) {
  write(Level::warning, fmt::format(text, std::forward<Args>(args)...));
}
template <class... Args>
void error(fmt::format_string<Args...> text, Args&&... args) {
  write(Level::error, fmt::format(text, std::forward<Args>(args)...));
}

}  // namespace liloc::log
