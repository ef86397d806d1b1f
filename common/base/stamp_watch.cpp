#include "common/base/stamp_watch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace liloc {
namespace {

constexpr int kStrays = 3;  // in a row: the clock was set. Two may be a hiccup of the driver; by hand
// Late ones of a stream are late by less; a clock set back by less has caught up as soon.
constexpr StampNs kBack = from_ms(500);
// Odometry does not bridge half of it; what is farther ahead may wait for two others to confirm it.
constexpr StampNs kAhead = from_ms(10'000);
constexpr double kRarest = 100 * kNsPerSecond;  // between two stamps of any stream, when units are guessed
// By which stamps may differ from this computer's time and still be of its clock; by hand.
constexpr double kHour = 3600 * kNsPerSecond;

struct Unit {
  double ns;
  const char* name;
};
constexpr std::array<Unit, 3> kUnits{{{1e3, "microseconds"}, {1e6, "milliseconds"}, {1e9, "seconds"}}};

}  // namespace

Status StampWatch::check_unit(StampNs stamp_ns) {
  seen_.push_back(stamp_ns);
  if (seen_.size() > rules_.judged) seen_.pop_front();
  if (seen_.size() < rules_.judged || !std::ranges::is_sorted(seen_) || seen_.back() == seen_.front())
    return {};
  const double rise = static_cast<double>(seen_.back() - seen_.front()) / static_cast<double>(seen_.size() - 1);
  if (rise >= static_cast<double>(rules_.closest_ns)) return {};
  for (const Unit& unit : kUnits)
    if (rise * unit.ns >= static_cast<double>(rules_.closest_ns) && rise * unit.ns <= kRarest)
      return fail("{} stamps rise by {:.0f}: they look like {}; pass nanoseconds", rules_.what, rise,
                  unit.name);
  return fail("{} stamps rise by {:.0f} ns only; pass nanoseconds of the moment of measuring", rules_.what,
              rise);
}

Result<StampNs> StampWatch::add_stray(StampNs stamp_ns) {
  const bool back = stamp_ns < *last_ns_;
  const bool goes_on =
      strays_ > 0 && back == (last_stray_ns_ < *last_ns_) && stamp_ns >= last_stray_ns_ - kBack;
  if (!goes_on) {
    strays_ = 1;
    first_stray_ns_ = last_stray_ns_ = stamp_ns;
  } else if (stamp_ns > last_stray_ns_) {
    ++strays_;
    last_stray_ns_ = stamp_ns;
  }
  if (strays_ < kStrays)
    return fail("{} stamp is {:.1f} s {} the last one ({}): dropped, unless others confirm it", rules_.what,
                std::abs(to_seconds(stamp_ns - *last_ns_)), back ? "before" : "after", *last_ns_);
  const StampNs apart_ns = (last_stray_ns_ - first_stray_ns_) / (kStrays - 1);
  const StampNs set_by_ns = first_stray_ns_ - apart_ns - *last_ns_;
  strays_ = 0;
  last_ns_ = stamp_ns;
  return set_by_ns;
}

Result<StampNs> StampWatch::add(StampNs stamp_ns) {
  if (stamp_ns <= 0)
    return fail("{} stamp is {}: it was not set; pass nanoseconds of the device's clock", rules_.what,
                stamp_ns);
  if (const Status unit = check_unit(stamp_ns); !unit) return tl::unexpected(unit.error());
  if (last_ns_) {
    // In floating point: the difference of two stamps need not fit into one.
    const double ahead = static_cast<double>(stamp_ns) - static_cast<double>(*last_ns_);
    if (ahead < -static_cast<double>(kBack) || ahead > static_cast<double>(kAhead)) return add_stray(stamp_ns);
    if (stamp_ns <= *last_ns_)
      return fail("{} stamp {} is not newer than the last one ({}): ignored", rules_.what, stamp_ns, *last_ns_);
  }
  strays_ = 0;
  last_ns_ = stamp_ns;
  return 0;
}

Status check_unit_by(StampNs wall_ns, StampNs stamp_ns, const std::string& what) {
  if (stamp_ns <= 0)
    return fail("{} stamp is {}: it was not set; pass nanoseconds of the device's clock", what, stamp_ns);
  for (const Unit& unit : kUnits)
    if (std::abs(static_cast<double>(stamp_ns) * unit.ns - static_cast<double>(wall_ns)) < kHour)
      return fail("{} stamp {} looks like {} since 1970; pass nanoseconds", what, stamp_ns, unit.name);
  return {};
}

}  // namespace liloc
