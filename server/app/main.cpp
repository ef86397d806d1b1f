// liloc-server: exit code 0 after an ordered stop, 1 when the network fails it, 2 for bad usage or a bad site.
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <systemd/sd-daemon.h>

#include <chrono>
#include <exception>

#include "common/base/stop_signals.hpp"
#include "common/recording/recording.hpp"
#include "server/app/json_line.hpp"
#include "server/app/server.hpp"

namespace liloc {
namespace {

/// To stderr, and to `tail`.
void open_log(log::Level level, bool json, const std::shared_ptr<view::LogTail>& tail) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("liloc-server"));
  spdlog::set_pattern(json ? "%v" : "%Y-%m-%d %H:%M:%S.%e %^%l%$ %v");
  const auto as_spdlog = [](log::Level l) {
    switch (l) {
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
  };
  spdlog::set_level(as_spdlog(level));
  spdlog::flush_on(spdlog::level::debug);
  log::set_sink([as_spdlog, json, level, tail](log::Level l, std::string_view line) {
    if (l >= level) tail->add(l, line);
    if (json)
      spdlog::log(as_spdlog(l), "{}", json_line(std::chrono::system_clock::now(), l, line));
    else
      spdlog::log(as_spdlog(l), "{}", line);
  });
}

int run(int argc, char** argv) {
  const StopSignals signals;
  int exit_code = 0;
  const auto options = parse_arguments(argc, argv, exit_code);
  if (!options) {
    if (!options.error().message.empty()) fmt::print(stderr, "liloc-server: {}\n", options.error().message);
    return exit_code;
  }
  const auto tail = std::make_shared<view::LogTail>();
  open_log(options->log_level, options->log_json, tail);
  const auto site = read_site(options->site_file);
  if (!site) {
    log::error("{}", site.error().message);
    return 2;
  }
  const auto server = Server::start(*options, *site, tail);
  if (!server) {
    log::error("{}", server.error().message);
    return 1;
  }
  log::info("{} serves {} with {} LiDARs on domain {}, interface {}", options->service.server_id,
            options->site_file, site->global_lidars.size(), options->seat.domain, options->seat.interface);
  sd_notify(0, "READY=1");  // does nothing where systemd did not start it
  if (options->metrics)
    log::info("metrics on http://{}:{}/metrics", options->metrics->host, (*server)->metrics_port());
  if (options->page) {
    log::info("page on {}", (*server)->page_url());
    if (!view::is_loopback(*options->page))
      log::warning(
          "the page travels unencrypted: put a proxy with TLS before it where others share the network");
  }
  log::info("signal {}: stopping", signals.wait());
  sd_notify(0, "STOPPING=1");
  (*server)->stop();
  const auto last = (*server)->status();
  log::info("stopped after {:.0f} s: {} answered, {} verified, {} refused", last.uptime_s, last.answered,
            last.verified, last.refused);
  return 0;
}

}  // namespace
}  // namespace liloc

int main(int argc, char** argv) {
  try {
    return liloc::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "liloc-server: {}\n", error.what());
    return 1;
  }
}
