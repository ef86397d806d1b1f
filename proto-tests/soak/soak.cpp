#include "proto-tests/soak/soak.hpp"

#include <algorithm>
#include <cstring>
#include <thread>

#include "common/recording/files.hpp"
#include "common/recording/writer.hpp"
#include "proto-tests/load/forked.hpp"
#include "proto-tests/soak/process_figures.hpp"
#include "proto-tests/soak/servers.hpp"
#include "proto-tests/soak/stage.hpp"
#include "proto-tests/soak/visitors.hpp"

namespace liloc::soak {
namespace {

constexpr auto kReport = "soak.json", kSamples = "samples.csv", kVisits = "visits.csv";
constexpr double kLead_s = 3;          // for processes and participants
constexpr double kMostSamples = 7200;  // of a process: every second for two hours, then more seldom
// What a process's floor may rise by after the warm-up. Of the server a room or two of 20 MB, by which sessions
// look back further in one third than in another. Measured: see DECISIONS.md.
constexpr double kMostServer_mb = 30, kMostClient_mb = 4, kMostVisitors_mb = 8, kMostStage_mb = 4;

class Run {
 public:
  Run(const Tape& tape, const SoakOptions& options, int domain)
      : tape_(tape),
        options_(options),
        clock_(RunClock::starting_in(kLead_s)),
        standby_(options, server_command(domain, true), options.out) {
    seat_.domain = domain;
  }

  Status start() {
    if (const Status forked = start_forked(); !forked) return forked;  // before this process joins DDS
    auto watch = StatusWatch::start(seat_);
    if (!watch) return tl::unexpected(watch.error());
    watch_ = std::move(*watch);
    auto server = replay::Child::start(server_command(seat_.domain, false), options_.out / "server.log");
    if (!server) return tl::unexpected(server.error());
    server_.emplace(std::move(*server));
    sample_of(server_->pid(), "server", kMostServer_mb);
    for (int i = 0; i < options_.residents; ++i)
      if (const Status started = start_resident(static_cast<std::size_t>(i)); !started) return started;
    sample_of(visitors_->pid(), "visitors", kMostVisitors_mb);
    sample_of(stage_->pid(), "sensors", kMostStage_mb);
    return {};
  }

  /// Until the run is over. Errors: a process ended by itself, a stop signal.
  Status watch(const std::function<void(double)>& progress) {
    const double every_s = std::max(1.0, options_.seconds / kMostSamples);
    double next_sample_s = 0;
    for (double now_s = clock_.now_s(); now_s < options_.seconds; now_s = clock_.now_s()) {
      if (replay::stop_requested()) return fail("soak: stopped by a signal");
      if (const Status all = all_run(); !all) return all;
      if (const Status tended = standby_.tend(now_s, watch_->board()); !tended) return tended;
      if (now_s >= next_sample_s) {
        if (const Status sampled = sample(now_s); !sampled) return sampled;
        next_sample_s += every_s;
      }
      if (progress) progress(std::max(0.0, now_s / options_.seconds));
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return {};
  }

  Result<SoakReport> collect() {
    SoakReport report = known(options_.seconds);
    const auto visits = visitors_->collect();
    if (!visits) return tl::unexpected(visits.error());
    if (const Status stopped = stop_children(); !stopped) return tl::unexpected(stopped.error());
    const auto flaps = stage_->collect();
    if (!flaps) return tl::unexpected(flaps.error());
    report.flaps = std::stoull(*flaps);
    report.restarts = standby_.restarts();
    report.silent_restarts = standby_.silent();
    std::vector<Visit> rows(visits->size() / sizeof(Visit));
    std::memcpy(rows.data(), visits->data(), rows.size() * sizeof(Visit));
    add_visits(rows, report);
    judge(report);
    return write(report, rows).map([&] { return report; });
  }

  /// Of a run that `trouble` ended: what was sampled, and that it failed. Nobody is told what cannot be written
  /// then: `trouble` matters more.
  void abandon(const Error& trouble) const {
    SoakReport report = known(std::clamp(clock_.now_s(), 0.0, options_.seconds));
    report.restarts = standby_.restarts();
    report.silent_restarts = standby_.silent();
    report.failures.push_back(trouble.message);
    (void)write(report, {});
  }

 private:
  /// What can be told at any time.
  [[nodiscard]] SoakReport known(double seconds) const {
    SoakReport report;
    report.seconds = seconds;
    report.judged_from_s = options_.warmup_s();
    const auto told = watch_ ? watch_->board().of("liloc") : std::nullopt;
    report.answered = told ? told->answered : 0;
    std::error_code error;
    const auto bytes = std::filesystem::file_size(options_.out / "server.log", error);
    if (!error && seconds > 0) report.log_kb_per_min = 1e-3 * static_cast<double>(bytes) / (seconds / 60);
    for (const Watched& watched : watched_)
      report.processes.push_back(summarize(watched, report.judged_from_s));
    return report;
  }
  [[nodiscard]] std::vector<std::string> server_command(int domain, bool standby) const {
    std::vector<std::string> command{options_.programs / "liloc-server",
                                     "--site",
                                     options_.out / "site.json",
                                     "--domain",
                                     std::to_string(domain),
                                     "--state",
                                     options_.out / (standby ? "standby.state.json" : "server.state.json")};
    if (standby) command.emplace_back("--standby");
    command.insert(command.end(), options_.server_options.begin(), options_.server_options.end());
    return command;
  }
  Status start_forked() {
    auto visitors = load::Forked::start([this]() -> Result<std::string> {
      return play_visitors(tape_, options_, clock_, seat_).map([](const std::vector<Visit>& visits) {
        return std::string(reinterpret_cast<const char*>(visits.data()), visits.size() * sizeof(Visit));
      });
    });
    if (!visitors) return tl::unexpected(visitors.error());
    visitors_.emplace(std::move(*visitors));
    wire::DomainOptions source = seat_;
    source.role = wire::Role::source;
    auto stage = load::Forked::start([this, source]() -> Result<std::string> {
      return play_stage(tape_, options_, clock_, source).map([](std::uint64_t flaps) {
        return std::to_string(flaps);
      });
    });
    if (!stage) return tl::unexpected(stage.error());
    stage_.emplace(std::move(*stage));
    return {};
  }
  Status start_resident(std::size_t number) {
    const DeviceInfo info = resident_of(tape_, number);
    const auto file = options_.out / (info.id + ".json");
    if (const Status written = write_device(file, info); !written) return written;
    auto child = replay::Child::start({options_.programs / "liloc-client", "--id", info.id, "--domain",
                                       std::to_string(seat_.domain), "--device", file},
                                      options_.out / (info.id + ".log"));
    if (!child) return tl::unexpected(child.error());
    sample_of(child->pid(), info.id, kMostClient_mb);
    residents_.push_back(std::move(*child));
    return {};
  }
  void sample_of(pid_t pid, std::string name, double most_mb) {
    pids_.push_back(pid);
    watched_.push_back({std::move(name), most_mb, {}, {}, {}});
  }
  Status sample(double now_s) {
    for (std::size_t i = 0; i < watched_.size(); ++i) {
      const auto figures = figures_of(pids_[i]);
      if (!figures) return fail("soak: {}: {}", watched_[i].name, why_ended(i, figures.error().message));
      watched_[i].memory_mb.push_back({now_s, figures->memory_mb});
      watched_[i].threads.push_back({now_s, static_cast<double>(figures->threads)});
      watched_[i].descriptors.push_back({now_s, static_cast<double>(figures->descriptors)});
    }
    return {};
  }
  /// A process of this run tells itself.
  std::string why_ended(std::size_t i, const std::string& otherwise) {
    for (auto* forked : {&visitors_, &stage_})
      if ((*forked)->pid() == pids_[i])
        if (const auto made = (*forked)->collect(); !made) return made.error().message;
    return otherwise;
  }
  Status all_run() {
    if (!server_->running()) return tl::unexpected(server_->failure());
    for (replay::Child& resident : residents_)
      if (!resident.running()) return tl::unexpected(resident.failure());
    return {};
  }
  Status stop_children() {
    for (replay::Child& resident : residents_) resident.ask_to_stop();
    Status first;
    for (replay::Child& resident : residents_)
      if (const Status stopped = resident.stop(kStopsWithin); !stopped && first) first = stopped;
    if (const Status stopped = standby_.stop(std::min(clock_.now_s(), options_.seconds), watch_->board());
        !stopped && first)
      first = stopped;
    if (const Status stopped = server_->stop(kStopsWithin); !stopped && first) first = stopped;
    return first;
  }
  Status write(const SoakReport& report, const std::vector<Visit>& visits) const {
    for (const auto& [name, text] : {std::pair{kReport, to_json(report)},
                                     {kSamples, samples_csv(watched_)},
                                     {kVisits, visits_csv(visits)}})
      if (const Status ok = write_file(options_.out / name, text); !ok) return ok;
    return {};
  }

  const Tape& tape_;
  const SoakOptions& options_;
  const RunClock clock_;
  wire::DomainOptions seat_;
  std::optional<load::Forked> visitors_, stage_;
  std::unique_ptr<StatusWatch> watch_;
  std::optional<replay::Child> server_;
  Standby standby_;
  std::vector<replay::Child> residents_;
  std::vector<pid_t> pids_;  ///< of `watched_`
  std::vector<Watched> watched_;
};

}  // namespace

Result<SoakReport> run_soak(const Tape& tape, const SoakOptions& options,
                            const std::function<void(double)>& progress) {
  if (const Status written = write_site(options.out / "site.json", tape.site); !written)
    return tl::unexpected(written.error());
  const auto domain = replay::free_domain();
  if (!domain) return tl::unexpected(domain.error());
  Run run(tape, options, *domain);
  auto report = [&]() -> Result<SoakReport> {
    if (const Status started = run.start(); !started) return tl::unexpected(started.error());
    if (const Status watched = run.watch(progress); !watched) return tl::unexpected(watched.error());
    return run.collect();
  }();
  if (!report) run.abandon(report.error());
  return report;
}

Status clear_results(const std::filesystem::path& out) {
  std::error_code error;
  std::filesystem::create_directories(out, error);
  for (const char* name : {kReport, kSamples, kVisits, "standby-silent.log"})
    if (!error) std::filesystem::remove(out / name, error);
  if (error) return fail("soak: {} cannot be written to ({}); name another", out.string(), error.message());
  return {};
}

}  // namespace liloc::soak
