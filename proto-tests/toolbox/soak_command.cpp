#include <fmt/format.h>

#include <memory>

#include "common/command/checks.hpp"
#include "proto-tests/replay/processes.hpp"
#include "proto-tests/soak/soak.hpp"
#include "proto-tests/toolbox/commands.hpp"

namespace liloc::toolbox {
namespace {

Result<soak::SoakReport> run_all(const soak::SoakOptions& options) {
  const Result<soak::Tape> tape = [&] {
    ProgressBar bar("simulating the site");
    return soak::record_tape(options, [&](double share) { bar.show(share); });
  }();
  if (!tape) return tl::unexpected(tape.error());
  ProgressBar bar("soaking");
  return soak::run_soak(*tape, options, [&](double share) { bar.show(share); });
}

int run(soak::SoakOptions& options) {
  replay::catch_stop_signals();
  options.programs = replay::program_folder();
  if (const Status ok = options.validated(); !ok) return complain(ok.error(), kBadUsage);
  if (const Status ok = soak::clear_results(options.out); !ok) return complain(ok.error(), kBadUsage);
  const auto report = run_all(options);
  if (!report) return complain(report.error(), kFailed);
  fmt::print("{}written to {}\n", soak::to_table(*report), options.out.string());
  return report->failures.empty() ? kDone : kFailed;
}

}  // namespace

void add_soak(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<soak::SoakOptions>();
  soak::SoakOptions& o = *options;
  CLI::App* command = app.add_subcommand(
      "soak", "A site for hours, in which clients, LiDARs and servers come and go: fails where anything grows");
  command->add_option("OUT", o.out, "Folder for soak.json, samples.csv, visits.csv, site.json and logs")
      ->required();
  command
      ->add_option(
          "--seconds", o.seconds,
          "Of the run; a quarter, 15 to 120 s, is warm-up and not judged; under 240 s nothing is said of "
          "growth")
      ->capture_default_str();
  command->add_option("--seed", o.seed, "Who comes and goes when, and the simulated site")
      ->check(command::any_seed())
      ->capture_default_str();
  command->add_option("--residents", o.residents, "liloc-client processes that stay")->capture_default_str();
  command->add_option("--visitors", o.visitors, "Clients that come and go, at once")->capture_default_str();
  command->add_option("--stay", o.stay_s, "Mean seconds that a visitor stays")->capture_default_str();
  command->add_option("--flap", o.flap_s, "Mean seconds until a ceiling LiDAR goes for 1 to 6 s; 0: never")
      ->capture_default_str();
  command
      ->add_option("--restart", o.restart_s,
                   "Seconds between restarts of the standby, stopped and killed in turn; 0: never")
      ->capture_default_str();
  command->add_option("--lidars", o.lidars, "Ceiling LiDARs")->capture_default_str();
  command->add_option("--people", o.people, "Walking about")->capture_default_str();
  command->add_option("--tape-seconds", o.tape_s, "Of simulated time, which is played to and fro")
      ->capture_default_str();
  command->add_option("--server-option", o.server_options,
                      "For both servers; may be repeated: --server-option=--workers=2");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace liloc::toolbox
