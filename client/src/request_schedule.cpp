#include "client/src/request_schedule.hpp"

namespace liloc {

bool RequestSchedule::due(StampNs stamp_ns, bool informative) {
  if (!informative) {
    after_gap_ = true;
    return false;
  }
  // Half a millisecond of slack: eight frames of 10 Hz are not to miss an interval of 800 ms by rounding.
  const bool interval_over = !last_ns_ || stamp_ns - *last_ns_ >= interval_ns_ - from_ms(0.5);
  if (!interval_over && !after_gap_) return false;
  after_gap_ = false;
  last_ns_ = stamp_ns;
  return true;
}

void RequestSchedule::answered(std::uint64_t seq) {
  std::erase_if(pending_, [seq](const Pending& p) { return p.seq == seq; });
}

std::vector<std::uint64_t> RequestSchedule::take_unanswered(StampNs stamp_ns) {
  std::vector<std::uint64_t> late;
  std::erase_if(pending_, [&](const Pending& p) {
    if (stamp_ns - p.stamp_ns < reply_timeout_ns_) return false;
    late.push_back(p.seq);
    return true;
  });
  return late;
}

}  // namespace liloc
