#include "client/inertial/motion_record.hpp"

#include <algorithm>

#include "client/inertial/sample_stamps.hpp"

namespace liloc {
namespace {

constexpr StampNs kSeenFor = from_ms(14'000);  // twelve steps of one frame a second
constexpr StampNs kFeltFor = from_ms(18'000);  // and three seconds on either side: ImuTrust's search

}  // namespace

void MotionRecord::feel(const ImuSample& sample) {
  if (!felt_.empty() && sample.stamp_ns <= last_.stamp_ns) felt_.clear();
  if (felt_.empty()) {
    felt_.push_back({sample.stamp_ns, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()});
  } else {
    const double dt = to_seconds(sample.stamp_ns - last_.stamp_ns);
    const Sum& sum = felt_.back();
    felt_.push_back({sample.stamp_ns,
                     sum.turn + 0.5 * dt * (sample.angular_velocity_rad_s + last_.angular_velocity_rad_s),
                     sum.push + 0.5 * dt * (sample.specific_force_m_s2 + last_.specific_force_m_s2)});
  }
  last_ = sample;
  while (sample.stamp_ns - felt_.front().stamp_ns > kFeltFor) felt_.pop_front();
}

void MotionRecord::see(const SeenStep& step) {
  seen_.push_back(step);
  while (step.to_ns - seen_.front().to_ns > kSeenFor) seen_.pop_front();
}

void MotionRecord::take_off(StampNs ahead_ns) {
  for (Sum& sum : felt_) sum.stamp_ns -= ahead_ns;
  last_.stamp_ns -= ahead_ns;
}

std::optional<MotionRecord::Sum> MotionRecord::at(StampNs stamp_ns) const {
  const auto after = std::ranges::upper_bound(felt_, stamp_ns, {}, &Sum::stamp_ns);
  if (after == felt_.begin() || after == felt_.end()) return std::nullopt;
  const Sum &a = *(after - 1), &b = *after;
  if (b.stamp_ns - a.stamp_ns > kLargestGapNs) return std::nullopt;
  const double share = to_seconds(stamp_ns - a.stamp_ns) / to_seconds(b.stamp_ns - a.stamp_ns);
  return Sum{stamp_ns, a.turn + share * (b.turn - a.turn), a.push + share * (b.push - a.push)};
}

std::optional<FeltStep> MotionRecord::felt(const SeenStep& step, StampNs ahead_ns) const {
  const auto from = at(step.from_ns + ahead_ns), to = at(step.to_ns + ahead_ns);
  if (!from || !to) return std::nullopt;
  return FeltStep{(to->turn - from->turn) / step.seconds(), (to->push - from->push) / step.seconds()};
}

}  // namespace liloc
