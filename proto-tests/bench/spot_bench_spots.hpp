#pragma once
// A run of `liloc_spot_bench` over sites or recordings.
#include <string>
#include <vector>

#include "proto-tests/bench/spot_bench_trial.hpp"

namespace liloc::bench {

struct SpotsOptions {
  int sites = 0;  ///< simulated, by rising seeds
  std::uint64_t first_seed = 1;
  double seconds = 12;                  ///< simulated per site
  SiteStyle style;                      ///< of the simulated sites
  std::vector<std::string> recordings;  ///< folders, in place of simulated sites
  int jobs = 1;                         ///< sites at a time
  bool verbose = false;                 ///< print every spot
  TrialOptions trial;
};

/// Runs all of them, in order, asks the peers for what was kept for them, and prints the tables. Error: the
/// first that a site met.
[[nodiscard]] Result<TrialResult> run_spots(const SpotsOptions& options);

}  // namespace liloc::bench
