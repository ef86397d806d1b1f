#pragma once
// What `liloc plan` predicts of a simulated site against what the server answers there.
#include <string>
#include <vector>

#include "proto-tests/bench/spot_bench_sites.hpp"
#include "server/plan/prediction.hpp"

namespace liloc::bench {

/// A pose that a plan looks from, and the answer to a cold request from there.
struct PlanRow {
  std::uint64_t seed = 0;
  plan::ViewFeatures features;
  double chance = 0;   ///< predicted that it is verified
  double overlap = 0;  ///< told by the reply
  bool verified = false, right = false;
};

struct PlanTrialOptions {
  double seconds = 7.1;  ///< simulated; requests are spread over all but the first three
  int poses = 48;        ///< asked from, drawn from all that the plan looks from
  SiteStyle style;
};

struct PlanTrial {
  std::string name;  ///< of the site, for people
  std::uint64_t seed = 0;
  double predicted = 0;  ///< share of all poses that are verified
  double coverage = 0;   ///< of the scan
  std::vector<PlanRow> rows;

  [[nodiscard]] double mean_chance() const;     ///< of the rows
  [[nodiscard]] double verified_share() const;  ///< of the rows
};

/// Scans the empty site of a seed, predicts from the scan and its LiDARs alone, fills it with people, and asks
/// the server from poses of the plan. Deterministic. Errors: the site's, the plan's.
[[nodiscard]] Result<PlanTrial> run_plan_trial(std::uint64_t seed, const PlanTrialOptions& options);

/// Error: the file cannot be written.
[[nodiscard]] Status write_plan_rows(const std::string& path, const std::vector<PlanTrial>& trials);

}  // namespace liloc::bench
