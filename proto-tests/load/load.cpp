#include "proto-tests/load/load.hpp"

#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>
#include <thread>

#include "common/recording/files.hpp"
#include "common/recording/writer.hpp"
#include "proto-tests/load/ceiling.hpp"
#include "proto-tests/load/forked.hpp"
#include "proto-tests/load/part.hpp"
#include "proto-tests/load/plot.hpp"
#include "proto-tests/replay/processes.hpp"

namespace liloc::load {
namespace {

constexpr double kAfter_s = 5;  // for the last replies

// ---- The server, as Linux shows it.

struct ProcessFigures {
  double cpu_s = 0, rss_mb = 0;
};

ProcessFigures figures_of(pid_t pid) {
  ProcessFigures figures;
  std::ifstream in(fmt::format("/proc/{}/stat", pid));
  std::string line;
  std::getline(in, line);
  const auto name_end = line.rfind(')');  // the name may hold blanks
  if (name_end == std::string::npos) return figures;
  std::istringstream fields(line.substr(name_end + 2));
  std::string skipped;
  for (int i = 3; i < 14; ++i) fields >> skipped;  // utime is field 14 of proc(5), rss field 24
  double user = 0, system = 0, pages = 0;
  fields >> user >> system;
  for (int i = 16; i < 24; ++i) fields >> skipped;
  fields >> pages;
  figures.cpu_s = (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
  figures.rss_mb = 1e-6 * pages * static_cast<double>(sysconf(_SC_PAGESIZE));
  return figures;
}

Result<std::optional<replay::Child>> start_server(const LoadOptions& options, int domain) {
  if (options.domain >= 0) return std::optional<replay::Child>();
  std::vector<std::string> command{options.programs / "liloc-server",
                                   "--site",
                                   options.out / "site.json",
                                   "--domain",
                                   std::to_string(domain),
                                   "--state",
                                   "none"};
  if (!options.credentials.empty()) command.insert(command.end(), {"--credentials", options.credentials});
  command.insert(command.end(), options.server_options.begin(), options.server_options.end());
  auto child = replay::Child::start(command, options.out / "server.log");
  if (!child) return tl::unexpected(child.error());
  return std::optional(std::move(*child));
}

// ---- A run.

class Run {
 public:
  Run(const Script& script, const LoadOptions& options, int clients, int domain)
      : script_(script), options_(options), clients_(clients) {
    const double lead_s = 2.5 + 0.01 * clients;  // for processes and participants
    clock_.start = std::chrono::steady_clock::now() + std::chrono::nanoseconds(from_seconds(lead_s));
    clock_.start_ns = wall_clock_ns() + from_seconds(lead_s);
    clock_.ceiling_from_s = -lead_s;
    clock_.from_s = LoadOptions::warmup_s(clients);
    clock_.to_s = clock_.from_s + options.seconds;
    seat_.domain = domain;
    seat_.credentials = options.credentials;
    if (!options.server.empty()) {
      seat_.peers = {options.server};
      seat_.interface = "auto";
    }
  }

  /// All processes; none of them is this one.
  Status start() {
    auto server = start_server(options_, seat_.domain);
    if (!server) return tl::unexpected(server.error());
    server_ = std::move(*server);
    wire::DomainOptions source = seat_;
    source.role = wire::Role::source;
    auto ceiling = Forked::start([this, source]() -> Result<std::string> {
      return stream_ceiling(script_, clock_, clock_.to_s + kAfter_s, source).map([](std::uint64_t bytes) {
        return std::to_string(bytes);
      });
    });
    if (!ceiling) return tl::unexpected(ceiling.error());
    ceiling_.emplace(std::move(*ceiling));
    const auto plans = draw_plans(options_, clients_, script_.paths.size());
    for (int part = 0; part < options_.processes; ++part)
      if (const Status started = start_part(part, plans); !started) return started;
    return {};
  }

  /// Until all devices have gone. Errors: the server ended, a stop signal.
  Status watch(const std::function<void(double)>& progress) {
    const double freeze_at_s = 0.5 * (clock_.from_s + clock_.to_s);
    std::optional<ProcessFigures> begun;
    bool frozen = false, thawed = false;
    for (double now_s = clock_.now_s(); now_s < clock_.to_s + kAfter_s; now_s = clock_.now_s()) {
      if (replay::stop_requested()) return fail("load: stopped by a signal");
      if (server_ && !server_->running()) return tl::unexpected(server_->failure());
      if (server_ && now_s >= clock_.from_s && !begun) begun = figures_of(server_->pid());
      if (options_.freeze_s > 0 && !frozen && now_s >= freeze_at_s) frozen = kill(server_->pid(), SIGSTOP) == 0;
      if (frozen && !thawed && now_s >= freeze_at_s + options_.freeze_s)
        thawed = kill(server_->pid(), SIGCONT) == 0;
      if (server_ && begun && now_s >= clock_.to_s && !server_figures_) {
        const ProcessFigures now = figures_of(server_->pid());
        server_figures_ = {now.cpu_s - begun->cpu_s, now.rss_mb};
      }
      if (progress) progress(std::max(0.0, now_s / (clock_.to_s + kAfter_s)));
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    if (frozen && !thawed) kill(server_->pid(), SIGCONT);  // it would not hear that it is to stop
    return {};
  }

  Result<LoadReport> collect() {
    Outcomes outcomes;
    double cpu_s = 0;
    for (Forked& part : parts_) {
      const auto bytes = part.collect();
      if (!bytes) return tl::unexpected(bytes.error());
      std::string_view rest = *bytes;
      take_rows(rest, outcomes.requests);
      take_rows(rest, outcomes.devices);
      cpu_s += part.cpu_s();
    }
    const auto ceiling_bytes = ceiling_->collect();
    if (!ceiling_bytes) return tl::unexpected(ceiling_bytes.error());
    LoadReport report = summarize(clients_, options_.seconds, outcomes);
    report.rx_mb += 1e-6 * std::stod(*ceiling_bytes);
    report.generator_cpu_s = cpu_s + ceiling_->cpu_s();
    if (server_figures_) {
      report.server_cpu_s = server_figures_->cpu_s;
      report.server_rss_mb = server_figures_->rss_mb;
    }
    if (server_)
      if (const Status stopped = server_->stop(); !stopped) return tl::unexpected(stopped.error());
    return report;
  }

 private:
  Status start_part(int part, const std::vector<DevicePlan>& plans) {
    std::vector<DevicePlan> own;
    for (std::size_t i = static_cast<std::size_t>(part); i < plans.size();
         i += static_cast<std::size_t>(options_.processes))
      own.push_back(plans[i]);
    auto forked = Forked::start([this, own]() -> Result<std::string> {
      return play_part(script_, options_, clock_, own, seat_).map([](const Outcomes& outcomes) {
        std::string bytes;
        append_rows(outcomes.requests, bytes);
        append_rows(outcomes.devices, bytes);
        return bytes;
      });
    });
    if (!forked) return tl::unexpected(forked.error());
    parts_.push_back(std::move(*forked));
    return {};
  }

  const Script& script_;
  const LoadOptions& options_;
  const int clients_;
  RunClock clock_;
  wire::DomainOptions seat_;
  std::optional<replay::Child> server_;
  std::optional<ProcessFigures> server_figures_;
  std::optional<Forked> ceiling_;
  std::vector<Forked> parts_;
};

}  // namespace

Result<LoadReport> run_load(const Script& script, const LoadOptions& options, int clients,
                            const std::function<void(double)>& progress) {
  if (const Status written = write_site(options.out / "site.json", script.site); !written)
    return tl::unexpected(written.error());
  const auto domain = options.domain >= 0 ? Result<int>(options.domain) : replay::free_domain();
  if (!domain) return tl::unexpected(domain.error());
  Run run(script, options, clients, *domain);
  if (const Status started = run.start(); !started) return tl::unexpected(started.error());
  if (const Status watched = run.watch(progress); !watched) return tl::unexpected(watched.error());
  return run.collect();
}

Status write_reports(const LoadOptions& options, const std::vector<LoadReport>& reports) {
  if (const Status written = write_file(options.out / "load.json", to_json(reports)); !written) return written;
  return write_file(options.out / "load.svg", plot_svg(reports, options.interval_ms));
}

}  // namespace liloc::load
