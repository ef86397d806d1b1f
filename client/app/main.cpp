// liloc-client: exit code 0 after an ordered stop, 1 when it fails, 2 for bad usage or a bad device file.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <exception>

#include "client/app/daemon.hpp"
#include "common/base/stop_signals.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;

constexpr auto kSummaryEvery = 10s;  // by hand

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

void open_log(log::Level level) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("liloc-client"));
  spdlog::set_pattern("%Y-%m-%d %H:%M:%S.%e %^%l%$ %v");
  spdlog::set_level(as_spdlog(level));
  spdlog::flush_on(spdlog::level::debug);
  log::set_sink([](log::Level l, std::string_view line) { spdlog::log(as_spdlog(l), "{}", line); });
}

int run(int argc, char** argv) {
  const StopSignals signals;
  int exit_code = 0;
  auto options = parse_arguments(argc, argv, exit_code);
  if (!options) {
    if (!options.error().message.empty()) fmt::print(stderr, "liloc-client: {}\n", options.error().message);
    return exit_code;
  }
  open_log(options->log_level);
  if (!options->device_file.empty())
    if (const Status ok = read_device_file(*options); !ok) {
      log::error("{}", ok.error().message);
      return 2;
    }
  auto daemon = Daemon::start(*options, [&] { return signals.within(0ms) != 0; });
  if (!daemon) {
    log::error("{}", daemon.error().message);
    return 1;
  }
  if (!*daemon) return 0;  // stopped while it waited for the camera
  log::info("{} listens on domain {}, interface {}", options->client.id, options->client.domain,
            options->client.network_interface);
  while (signals.within(kSummaryEvery) == 0) log::debug("{}", (*daemon)->summary());
  log::info("stopping");
  const Status stopped = (*daemon)->stop();
  log::info("{}", (*daemon)->summary());
  if (stopped) return 0;
  log::error("{}", stopped.error().message);
  return 1;
}

}  // namespace
}  // namespace liloc

int main(int argc, char** argv) {
  try {
    return liloc::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "liloc-client: {}\n", error.what());
    return 1;
  }
}
