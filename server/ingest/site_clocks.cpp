#include "server/ingest/site_clocks.hpp"

#include <algorithm>
#include <cstdlib>

#include "common/base/quantile.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;

// Nearer than this, a slow network or driver cannot be told from a clock that is off.
constexpr StampNs kAgree = from_ms(300);
constexpr StampNs kNearWall = from_ms(10'000);  // hosts without NTP drift by less in a month
constexpr StampNs kSteady = from_ms(50);        // what delays of frames leave of a constant offset
constexpr auto kProof = 2s;                     // so long an offset has to hold before it is taken for steady
constexpr StampNs kFollow = 64;  // frames: slower than delays vary, quicker than any oscillator drifts

StampNs steady_ns(SiteClocks::Time time) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
}

/// In floating point: the difference of two stamps need not fit into one.
double apart(StampNs a, StampNs b) {
  return std::abs(static_cast<double>(a) - static_cast<double>(b));
}

/// Whoever agrees with `leads[first]`, of rising leads.
std::size_t group_size(const std::vector<StampNs>& leads, std::size_t first) {
  std::size_t end = first;
  while (end < leads.size() && apart(leads[end], leads[first]) <= static_cast<double>(kAgree)) ++end;
  return end - first;
}

}  // namespace

void SiteClocks::choose(Time at, StampNs wall_ns) {
  std::vector<StampNs> leads;
  for (const Lidar& lidar : lidars_)
    if (const auto now = lidar.clock.now(at)) leads.push_back(*now - steady_ns(at));
  if (leads.empty()) return;
  std::ranges::sort(leads);
  std::size_t most = 0;
  for (std::size_t i = 0; i < leads.size(); ++i) most = std::max(most, group_size(leads, i));
  std::vector<StampNs> middles;
  for (std::size_t i = 0; i < leads.size(); ++i)
    if (group_size(leads, i) == most)
      middles.push_back(median(std::vector(leads.begin() + static_cast<std::ptrdiff_t>(i),
                                           leads.begin() + static_cast<std::ptrdiff_t>(i + most))));
  const auto nearest_to = [&](StampNs lead_ns) {
    return *std::ranges::min_element(middles, {}, [&](StampNs middle) { return apart(middle, lead_ns); });
  };
  const StampNs wall_lead_ns = wall_ns - steady_ns(at), by_wall_ns = nearest_to(wall_lead_ns);
  const bool wall_tells = apart(by_wall_ns, wall_lead_ns) <= static_cast<double>(kNearWall) || !lead_ns_;
  lead_ns_ = wall_tells ? by_wall_ns : nearest_to(*lead_ns_);
}

/// A lone frame may tell an offset by chance: it counts when it has held for a while.
void SiteClocks::judge(Lidar& lidar, StampNs ahead_ns, Time at) {
  lidar.offset.ahead_ns = ahead_ns;
  if (std::abs(ahead_ns) <= kAgree) {
    lidar.offset = {ahead_ns, false, false};
    lidar.steady_since.reset();
    return;
  }
  if (!lidar.steady_since || std::abs(ahead_ns - lidar.steady_ns) > kSteady) {
    lidar.steady_since = at;
    lidar.steady_ns = ahead_ns;
    lidar.offset.corrected = false;
  }
  lidar.steady_ns += (ahead_ns - lidar.steady_ns) / kFollow;
  if (at - *lidar.steady_since >= kProof) lidar.offset.corrected = true;
  if (lidar.offset.corrected) lidar.offset.ahead_ns = lidar.steady_ns;
  lidar.offset.left_out = !lidar.offset.corrected;
}

std::optional<StampNs> SiteClocks::add(std::size_t index, StampNs stamp_ns, Time arrived, StampNs wall_ns) {
  Lidar& lidar = lidars_[index];
  (void)lidar.clock.add(stamp_ns, arrived);
  choose(arrived, wall_ns);
  const auto now = lidar.clock.now(arrived);
  if (!now || !lead_ns_) return std::nullopt;
  judge(lidar, *now - steady_ns(arrived) - *lead_ns_, arrived);
  if (lidar.offset.left_out) return std::nullopt;
  return lidar.offset.corrected ? stamp_ns - lidar.offset.ahead_ns : stamp_ns;
}

std::optional<StampNs> SiteClocks::now(Time at) const {
  const bool heard =
      std::ranges::any_of(lidars_, [&](const Lidar& lidar) { return lidar.clock.now(at).has_value(); });
  if (!heard || !lead_ns_) return std::nullopt;
  return steady_ns(at) + *lead_ns_;
}

}  // namespace liloc
