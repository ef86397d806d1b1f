#include "client/engine/request_schedule.hpp"

#include <algorithm>

namespace liloc {
namespace {

// Half a millisecond of slack: eight frames of 10 Hz are not to miss an interval of 800 ms by rounding.
constexpr StampNs kSlack = from_ms(0.5);

/// Whether the next frame may fare better, and the server has time for it.
bool worth_another(const SpotReply& reply) {
  return reply.status != SpotStatus::refused || reply.reason == Reason::not_found ||
         reply.reason == Reason::no_gpc;
}

}  // namespace

RequestSchedule::RequestSchedule(RequestScheduleOptions options) : options_(options) {
  if (options_.searching_interval_ns <= 0) options_.searching_interval_ns = options_.interval_ns / 4;
}

bool RequestSchedule::due(StampNs stamp_ns, bool informative, bool sure) {
  if (!sure) after_doubt_ = true;
  if (!informative) {
    after_gap_ = true;
    return false;
  }
  const bool interval_over = !last_ns_ || stamp_ns - *last_ns_ >= options_.interval_ns - kSlack;
  const bool hurried = (!located_ || with_new_server_) && hurried_ns_ && stamp_ns >= *hurried_ns_ - kSlack;
  const bool soon = !last_ns_ || stamp_ns - *last_ns_ >= options_.searching_interval_ns - kSlack;
  if (!interval_over && !hurried && !(soon && (after_gap_ || (sure && after_doubt_)))) return false;
  after_gap_ = false;
  if (sure) after_doubt_ = false;
  hurried_ns_.reset();
  if (last_ns_) gap_ns_ = stamp_ns - *last_ns_;
  last_ns_ = stamp_ns;
  if (!searching_since_ns_) searching_since_ns_ = stamp_ns;
  return true;
}

void RequestSchedule::sent(std::uint64_t seq, StampNs stamp_ns) {
  pending_.push_back({seq, stamp_ns});
}

StampNs RequestSchedule::searching_gap_ns() const {
  const bool fresh = *last_ns_ - *searching_since_ns_ < options_.interval_ns - kSlack;
  return fresh ? options_.searching_interval_ns : std::max(options_.searching_interval_ns, 2 * gap_ns_);
}

void RequestSchedule::answered(const SpotReply& reply, StampNs now_ns) {
  if (reply.verified()) with_new_server_ = false;
  const bool newest = !pending_.empty() && pending_.back().seq == reply.seq;
  std::erase_if(pending_, [&](const Pending& p) { return p.seq == reply.seq; });
  if (!newest || !worth_another(reply)) return;
  const StampNs took_ns = std::max<StampNs>(now_ns - *last_ns_, 0);
  hurried_ns_ = *last_ns_ + std::max(searching_gap_ns(), 2 * took_ns);
}

void RequestSchedule::server_found() {
  after_gap_ = true;
  with_new_server_ = true;
  searching_since_ns_.reset();
}

void RequestSchedule::search_begins() {
  located_ = false;
  searching_since_ns_.reset();
  if (last_ns_ && pending_.empty()) hurried_ns_ = *last_ns_ + options_.searching_interval_ns;
}

void RequestSchedule::clock_set(StampNs by_ns) {
  for (std::optional<StampNs>* stamp : {&last_ns_, &hurried_ns_, &searching_since_ns_})
    if (*stamp) **stamp += by_ns;
  for (Pending& p : pending_) p.stamp_ns += by_ns;
}

std::vector<std::uint64_t> RequestSchedule::take_unanswered(StampNs stamp_ns) {
  std::vector<std::uint64_t> late;
  std::erase_if(pending_, [&](const Pending& p) {
    if (stamp_ns - p.stamp_ns < options_.reply_timeout_ns) return false;
    late.push_back(p.seq);
    return true;
  });
  return late;
}

}  // namespace liloc
