#include "proto-tests/load/plan.hpp"

#include <algorithm>
#include <cmath>

#include "proto-tests/sim/base/random.hpp"

namespace liloc::load {
namespace {

/// Of a process without memory.
double waiting_s(sim::Random& random, double mean_s) {
  return -mean_s * std::log(1 - random.unit());
}

DevicePlan draw(const LoadOptions& options, std::size_t paths, sim::Random& random, double start_s,
                double end_s) {
  DevicePlan plan;
  plan.start_s = start_s;
  plan.end_s = end_s;
  plan.path = static_cast<std::size_t>(random.below(static_cast<int>(paths)));
  plan.clock_offset_s = random.uniform(-options.clock_offset_s, options.clock_offset_s);
  plan.seed = static_cast<std::uint64_t>(random.unit() * 0x1.0p53);
  if (options.kidnap_s > 0)
    for (double at_s = start_s + waiting_s(random, options.kidnap_s); at_s < end_s;
         at_s += std::max(1.0, waiting_s(random, options.kidnap_s)))
      plan.kidnaps_s.push_back(at_s);
  return plan;
}

}  // namespace

std::vector<DevicePlan> draw_plans(const LoadOptions& options, int clients, std::size_t paths) {
  constexpr double kAtLeast_s = 1;  // a shorter stay ends before the first answer
  const double warmup_s = LoadOptions::warmup_s(clients), end_s = warmup_s + options.seconds;
  const double lost_at_s = warmup_s + 0.2 * options.seconds;
  std::vector<DevicePlan> plans;
  for (int i = 0; i < clients; ++i) {
    sim::Random random(options.seed, 1000 + static_cast<std::uint64_t>(i));
    const bool lost = i < std::lround(options.lost_share * clients);
    double start_s = options.in_phase ? 0 : random.uniform(0, 0.7 * warmup_s);
    for (int stay = 0; start_s < end_s - kAtLeast_s; ++stay) {
      const double stays_s =
          options.churn_s > 0 ? std::max(kAtLeast_s, waiting_s(random, options.churn_s)) : end_s;
      DevicePlan plan = draw(options, paths, random, start_s, std::min(end_s, start_s + stays_s));
      plan.id = fmt::format("load{}-{}", i, stay);
      if (lost && plan.start_s < lost_at_s && lost_at_s < plan.end_s) plan.lost_at_s = lost_at_s;
      start_s = plan.end_s;
      plans.push_back(std::move(plan));
    }
  }
  return plans;
}

}  // namespace liloc::load
