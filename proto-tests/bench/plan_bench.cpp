// How well `liloc plan` predicts simulated sites: the share of device poses whose single requests are verified.
//
//   liloc_plan_bench --sites 50 --first-seed 4001 [--world 2] [--poses 72] [--rows rows.csv]
//
// fit_plan.py makes the prediction of the rows.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "proto-tests/bench/plan_trial.hpp"

namespace liloc::bench {
namespace {

struct Options {
  int sites = 10;
  std::uint64_t first_seed = 1;
  std::string rows;
  PlanTrialOptions trial;
};

void print_summary(const std::vector<PlanTrial>& trials) {
  double predicted = 0, chance = 0, verified = 0, off = 0;
  std::size_t poses = 0, wrong = 0;
  for (const PlanTrial& trial : trials) {
    predicted += trial.predicted;
    chance += trial.mean_chance();
    verified += trial.verified_share();
    off += std::abs(trial.mean_chance() - trial.verified_share());
    poses += trial.rows.size();
    for (const PlanRow& row : trial.rows) wrong += row.verified && !row.right ? 1 : 0;
  }
  const double n = static_cast<double>(std::max<std::size_t>(1, trials.size()));
  fmt::print(
      "{} sites, {} poses: predicted {:.1f} % of all poses, {:.1f} % of those asked from; verified {:.1f} "
      "%; a site is off by {:.1f} points on average; {} verified wrong\n",
      trials.size(), poses, 100 * predicted / n, 100 * chance / n, 100 * verified / n, 100 * off / n, wrong);
}

Status run(const Options& options) {
  std::vector<PlanTrial> trials;
  fmt::print("seed   coverage  predicted  of the asked  verified  site\n");
  for (int i = 0; i < options.sites; ++i) {
    auto trial = run_plan_trial(options.first_seed + static_cast<std::uint64_t>(i), options.trial);
    if (!trial) return tl::unexpected(trial.error());
    fmt::print("{:<6} {:7.1f} % {:8.1f} % {:11.1f} % {:7.1f} %  {}\n", trial->seed, 100 * trial->coverage,
               100 * trial->predicted, 100 * trial->mean_chance(), 100 * trial->verified_share(), trial->name);
    std::fflush(stdout);
    trials.push_back(std::move(*trial));
  }
  print_summary(trials);
  return options.rows.empty() ? Status{} : write_plan_rows(options.rows, trials);
}

}  // namespace
}  // namespace liloc::bench

int main(int argc, char** argv) {
  liloc::bench::Options options;
  CLI::App app{"What liloc plan predicts of simulated sites, against what the server answers there"};
  app.add_option("--sites", options.sites, "Number of sites")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--first-seed", options.first_seed, "Seed of the first site")->capture_default_str();
  app.add_option("--world", options.trial.style.world, "Whose furniture, people and mounts: 1 or 2")
      ->check(CLI::Range(1, 2))
      ->capture_default_str();
  app.add_option("--poses", options.trial.poses, "To ask from, per site")
      ->check(CLI::Range(1, 5000))
      ->capture_default_str();
  app.add_option("--seconds", options.trial.seconds, "Simulated per site")
      ->check(CLI::Range(4, 600))
      ->capture_default_str();
  app.add_option("--rows", options.rows, "Write a row per pose, for fit_plan.py");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const auto done = liloc::bench::run(options);
  if (!done) fmt::print(stderr, "liloc_plan_bench: {}\n", done.error().message);
  return done ? 0 : 1;
}
