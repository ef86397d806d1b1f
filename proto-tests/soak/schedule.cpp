#include "proto-tests/soak/schedule.hpp"

#include <algorithm>
#include <cmath>

#include "proto-tests/sim/base/random.hpp"

namespace liloc::soak {
namespace {

constexpr double kFirst_s = 5;                       // when all is there, before anybody goes
constexpr double kAwayLeast_s = 1, kAwayMost_s = 6;  // over what a server waits for a LiDAR, and below
constexpr double kStayLeast_s = 3, kPauseLeast_s = 0.2, kPauseMost_s = 2;
constexpr double kLast_s = 2;  // before the end nobody comes any more

/// Of a process without memory.
double waiting_s(sim::Random& random, double mean_s) {
  return -mean_s * std::log(1 - random.unit());
}

}  // namespace

std::vector<Span> draw_flaps(const SoakOptions& options, std::size_t lidar) {
  std::vector<Span> flaps;
  if (options.flap_s == 0) return flaps;
  sim::Random random(options.seed, 2000 + lidar);
  for (double at_s = kFirst_s + waiting_s(random, options.flap_s);;) {
    const double back_s = at_s + random.uniform(kAwayLeast_s, kAwayMost_s);
    if (back_s > options.seconds - kLast_s) return flaps;
    flaps.push_back({at_s, back_s});
    at_s = back_s + std::max(1.0, waiting_s(random, options.flap_s));
  }
}

std::vector<Span> draw_visits(const SoakOptions& options, std::size_t place) {
  std::vector<Span> visits;
  sim::Random random(options.seed, 3000 + place);
  double at_s = random.uniform(0, kFirst_s);
  while (at_s < options.seconds - kLast_s) {
    const double stay_s = kStayLeast_s + waiting_s(random, options.stay_s - kStayLeast_s);
    visits.push_back({at_s, std::min(at_s + stay_s, options.seconds)});
    at_s = visits.back().to_s + random.uniform(kPauseLeast_s, kPauseMost_s);
  }
  return visits;
}

}  // namespace liloc::soak
