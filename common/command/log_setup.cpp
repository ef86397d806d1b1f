#include "common/command/log_setup.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <utility>

namespace liloc::command {
namespace {

spdlog::level::level_enum as_spdlog(log::Level level) {
  switch (level) {
    case log::Level::debug:
      return spdlog::level::debug;
    case log::Level::info:
      return spdlog::level::info;
    case log::Level::warning:
      return spdlog::level::warn;
    case log::Level::error:
      return spdlog::level::err;
  }
  return spdlog::level::info;
}

}  // namespace

log::Sink stderr_sink(const std::string& program, log::Level least, LineFormat format) {
  const auto logger =
      std::make_shared<spdlog::logger>(program, std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
  logger->set_pattern(format ? "%v" : "%Y-%m-%d %H:%M:%S.%e %^%l%$ %v");
  logger->set_level(as_spdlog(least));
  logger->flush_on(spdlog::level::debug);
  return [logger, format = std::move(format)](log::Level level, std::string_view line) {
    if (format)
      logger->log(as_spdlog(level), "{}", format(level, line));
    else
      logger->log(as_spdlog(level), "{}", line);
  };
}

}  // namespace liloc::command
