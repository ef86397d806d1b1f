// liloc-client: exit code 0 after an ordered stop, 1 when it fails, 2 for bad usage or a bad device file.
#include <chrono>
#include <exception>

#include "client/app/daemon.hpp"
#include "common/base/stop_signals.hpp"
#include "common/command/log_setup.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;

constexpr auto kSummaryEvery = 10s;  // by hand

int run(int argc, char** argv) {
  const StopSignals signals;
  int exit_code = 0;
  auto options = parse_arguments(argc, argv, exit_code);
  if (!options) {
    if (!options.error().message.empty()) fmt::print(stderr, "liloc-client: {}\n", options.error().message);
    return exit_code;
  }
  log::set_sink(command::stderr_sink("liloc-client", options->log_level));
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
