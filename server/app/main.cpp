// liloc-server: exit code 0 after an ordered stop, 1 when the network fails it, 2 for bad usage or a bad site.
#include <malloc.h>
#include <systemd/sd-daemon.h>

#include <chrono>
#include <exception>

#include "common/base/stop_signals.hpp"
#include "common/command/log_setup.hpp"
#include "common/credentials/credentials_watch.hpp"
#include "common/credentials/end_of_credentials.hpp"
#include "common/recording/recording.hpp"
#include "server/app/json_line.hpp"
#include "server/app/server.hpp"

namespace liloc {
namespace {

std::string as_json(log::Level level, std::string_view line) {
  return json_line(std::chrono::system_clock::now(), level, line);
}

constexpr auto kLookEvery =
    std::chrono::seconds(2);  // at credentials: twice, and devices join anew within 10 s

/// Until a stop signal, which it returns. Errors: the network, when it joined again.
Result<int> serve(Server& server, const ServerOptions& options, CredentialsWatch& credentials,
                  const StopSignals& signals) {
  const std::string& folder = options.seat.credentials;
  EndOfCredentials end(folder, std::chrono::steady_clock::now());
  bool changed = false, told = false;  // what cannot be read yet is looked at again: a key's owner may follow
  for (;;) {
    if (const int signal = signals.within(kLookEvery)) return signal;
    end.look(std::chrono::steady_clock::now());
    if (credentials.changed()) changed = true, told = false;
    if (!changed) continue;
    if (const auto good = read_credentials(folder); !good) {
      if (!told) log::error("{}; the credentials before these stay in use", good.error().message);
      told = true;
      continue;
    }
    changed = false;
    log::info("{} has changed: everybody joins anew", folder);
    if (const Status joined = server.rejoin(options); !joined) return tl::unexpected(joined.error());
    end = EndOfCredentials(folder, std::chrono::steady_clock::now());
  }
}

int run(int argc, char** argv) {
  // A heap for each thread keeps what the others could use: 12 devices took 660 MB with them, 380 MB with one.
  mallopt(M_ARENA_MAX, 2);
  const StopSignals signals;
  int exit_code = 0;
  const auto options = parse_arguments(argc, argv, exit_code);
  if (!options) {
    if (!options.error().message.empty()) fmt::print(stderr, "liloc-server: {}\n", options.error().message);
    return exit_code;
  }
  const auto tail = std::make_shared<view::LogTail>();
  const auto to_stderr = command::stderr_sink("liloc-server", options->log_level,
                                              options->log_json ? as_json : command::LineFormat{});
  log::set_sink([tail, to_stderr, least = options->log_level](log::Level level, std::string_view line) {
    if (level >= least) tail->add(level, line);
    to_stderr(level, line);
  });
  const auto site = read_site(options->site_file);
  if (!site) {
    log::error("{}", site.error().message);
    return 2;
  }
  CredentialsWatch credentials(options->seat.credentials);  // before they are read: none may change unseen
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
    // Past the tail: who looks at the page must not read its token there.
    to_stderr(log::Level::info, fmt::format("page on {}", (*server)->page_url()));
    if (!web::is_loopback(*options->page))
      log::warning(
          "the page travels unencrypted: put a proxy with TLS before it where others share the network");
  }
  const auto signal = serve(**server, *options, credentials, signals);
  if (!signal) {
    log::error("{}", signal.error().message);
    return 1;
  }
  log::info("signal {}: stopping", *signal);
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
