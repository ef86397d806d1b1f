#include "client/engine/map_link.hpp"

#include <algorithm>

namespace liloc {

bool MapLink::add(const SpotReply& reply, std::uint32_t segment) {
  if (reply.odom_segment != segment) return false;
  if (reply.status != SpotStatus::refused) answered_ns_ = std::max(answered_ns_, reply.stamp_ns);
  if (!reply.verified() || !reply.T_map_odom) return false;
  if (T_map_odom_ && reply.stamp_ns < verified_ns_) return false;  // overtaken by the answer to a later frame
  T_map_odom_ = normalized(*reply.T_map_odom);
  verified_segment_ = segment;
  verified_ns_ = reply.stamp_ns;
  return true;
}

void MapLink::clock_set(StampNs by_ns) {
  answered_ns_ += by_ns;
  verified_ns_ += by_ns;
}

Tracking MapLink::tracking(StampNs now_ns, std::uint32_t segment) const {
  if (!T_map_odom_) return Tracking::searching;
  const bool silent = now_ns - answered_ns_ > silent_after_ns_;
  return silent || !located(segment) ? Tracking::coasting : Tracking::tracking;
}

}  // namespace liloc
