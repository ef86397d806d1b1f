#include "client/session/session_clock.hpp"

namespace liloc {

bool SessionClock::frame(StampNs stamp_ns, Time arrived) {
  const std::scoped_lock lock(mutex_);
  if (!device_.add(stamp_ns, arrived)) return false;
  ceiling_.reset();
  return true;
}

void SessionClock::forget() {
  const std::scoped_lock lock(mutex_);
  device_ = {};
  ceiling_.reset();
}

void SessionClock::stamp(SpotRequest& request, Time sent) const {
  const std::scoped_lock lock(mutex_);
  request.sent_ns = device_.now(sent).value_or(0);
  request.ceiling_stamp_ns = ceiling_.ceiling_stamp(request.stamp_ns).value_or(0);
}

bool SessionClock::learn(const SpotReply& reply, Time arrived) {
  const std::scoped_lock lock(mutex_);
  const auto now_ns = device_.now(arrived);
  return now_ns &&
         ceiling_.add({reply.request_sent_ns, reply.server_received_ns, reply.server_sent_ns, *now_ns});
}

std::optional<ClockOffset> SessionClock::offset() const {
  const std::scoped_lock lock(mutex_);
  return ceiling_.offset();
}

}  // namespace liloc
