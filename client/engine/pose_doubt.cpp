#include "client/engine/pose_doubt.hpp"

#include <algorithm>

namespace liloc {
namespace {

constexpr std::size_t kMostAsked = 64;  // a minute at the usual interval; answers come within seconds; by hand
// Of a device that people carry, over a stretch that the odometry could not bridge: MotionDoubt bounds it
// alike.
constexpr double kUnseenSpeed = 1.0, kUnseenTurn = 0.5;  // m/s, rad/s; by hand
// Of odometry whose inputs contradict each other: who walks slowly while nothing is known. By hand: it must
// reach `lost` within seconds, and not within an interval.
constexpr double kContradictedSpeed = 0.2, kContradictedTurn = 0.1;  // m/s, rad/s

PoseEstimate widened(PoseEstimate estimate, double sd_rad, double sd_m) {
  return carried(estimate, Pose::Identity(), sd_rad, sd_m);
}

}  // namespace

/// The new segment begins where the guess had come to, and in between nobody saw where the device went.
void PoseDoubt::bridge(StampNs stamp_ns, const OdometryStep& step) {
  const double unseen_s = to_seconds(stamp_ns - measured_ns_);
  if (auto now = estimate()) last_ = widened(*now, kUnseenTurn * unseen_s, kUnseenSpeed * unseen_s);
  T_odom_last_ = step.T_odom_sensor;
  asked_.clear();
}

void PoseDoubt::travelled(StampNs stamp_ns, const OdometryStep& step, const MotionSd& since_asked,
                          const Against& against) {
  if (step.segment != segment_) bridge(stamp_ns, step);
  segment_ = step.segment;
  T_odom_sensor_ = step.T_odom_sensor;
  sd_ = since_asked;
  contradicted_ = against.contradicted;
  if (!against.misfit)
    misfit_ns_ = 0;
  else if (misfit_ns_ == 0)
    misfit_ns_ = measured_ns_;
  stamp_ns_ = stamp_ns;
  if (step.converged || measured_ns_ == 0) measured_ns_ = stamp_ns;
}

void PoseDoubt::asked(StampNs stamp_ns) {
  if (last_) last_ = carried(*last_, T_odom_last_.inverse() * T_odom_sensor_, sd_.rad, sd_.m);
  T_odom_last_ = T_odom_sensor_;
  asked_.push_back({stamp_ns, T_odom_sensor_, sd_});
  if (asked_.size() > kMostAsked) asked_.pop_front();
  sd_ = {};
}

void PoseDoubt::verified(const SpotReply& reply) {
  const auto at = std::ranges::find_if(asked_, [&](const Asked& a) { return a.stamp_ns >= reply.stamp_ns; });
  if (!reply.T_map_odom || at == asked_.end()) return;
  PoseEstimate estimate{*reply.T_map_odom * at->T_odom_sensor, reply.covariance};
  for (auto next = at + 1; next != asked_.end(); ++next)
    estimate =
        carried(estimate, next[-1].T_odom_sensor.inverse() * next->T_odom_sensor, next->sd.rad, next->sd.m);
  last_ = estimate;
  asked_.erase(asked_.begin(), at);
  verified_ns_ = reply.stamp_ns;
}

void PoseDoubt::clock_set(StampNs by_ns) {
  for (StampNs* stamp : {&stamp_ns_, &measured_ns_, &verified_ns_, &misfit_ns_})
    if (*stamp != 0) *stamp += by_ns;
}

std::optional<PoseEstimate> PoseDoubt::estimate() const {
  if (!last_) return std::nullopt;
  const PoseEstimate now = carried(*last_, T_odom_last_.inverse() * T_odom_sensor_, sd_.rad, sd_.m);
  const double unknown_s = contradicted_ ? to_seconds(stamp_ns_ - verified_ns_) : 0;
  const double unseen_s = misfit_ns_ != 0 ? to_seconds(stamp_ns_ - misfit_ns_) : 0;
  return widened(now, kContradictedTurn * unknown_s + kUnseenTurn * unseen_s,
                 kContradictedSpeed * unknown_s + kUnseenSpeed * unseen_s);
}

}  // namespace liloc
