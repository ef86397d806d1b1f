// liloc-client: exit code 0 after an ordered stop, 1 when it fails or has to be started anew
// (Daemon::check_address), 2 for bad usage or a bad device file.
#include <chrono>
#include <exception>

#include "client/app/daemon.hpp"
#include "common/base/stop_signals.hpp"
#include "common/command/log_setup.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;

constexpr auto kLookEvery = 500ms;  // at the address; by hand
constexpr int kSummaryEvery = 20;   // looks: each 10 s; by hand

/// Until a stop signal. Errors: it has to be started anew.
Status serve(Daemon& daemon, const StopSignals& signals) {
  for (int looks = 1; signals.within(kLookEvery) == 0; ++looks) {
    if (const Status same = daemon.check_address(); !same) return same;
    if (looks % kSummaryEvery == 0) log::debug("{}", daemon.summary());
  }
  return {};
}

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
  const Status served = serve(**daemon, signals);
  if (!served) log::error("{}", served.error().message);
  log::info("stopping");
  const Status stopped = (*daemon)->stop();
  log::info("{}", (*daemon)->summary());
  if (!stopped) log::error("{}", stopped.error().message);
  return served && stopped ? 0 : 1;
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
