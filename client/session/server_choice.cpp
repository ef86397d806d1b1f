#include "client/session/server_choice.hpp"

#include <algorithm>

namespace liloc {
namespace {

using namespace std::chrono_literals;

// By hand: above what answers of one kind differ by on a calm network (20 ms), below half an interval, so that
// the second request still decides where the followed server is slow throughout.
constexpr auto kLeastPatience = 100ms, kMostPatience = 400ms;
constexpr int kLagMargin = 2;     // times what was seen of late; by hand
constexpr double kFades = 0.875;  // of what was seen, with each request: half of it in five; by hand

}  // namespace

std::chrono::nanoseconds ServerChoice::patience() const {
  return std::clamp<std::chrono::nanoseconds>(kLagMargin * lag_, kLeastPatience, kMostPatience);
}

bool ServerChoice::takes(const SpotReply& reply, Time now) {
  const bool verified = reply.verified();
  if (reply.server_id != followed_ && answered_seq_ > 0) {
    const std::uint64_t seq = verified ? verified_seq_ : answered_seq_;  // what the followed one has to match
    if (reply.seq <= seq + 1) {
      hold(reply, now);
      return false;
    }
  }
  follow(reply, now);
  return true;
}

void ServerChoice::hold(const SpotReply& reply, Time now) {
  const std::uint64_t than = held_ ? std::max(answered_seq_, held_->reply.seq) : answered_seq_;
  if (reply.verified() && reply.seq > than) held_ = Held{reply, now};
}

void ServerChoice::follow(const SpotReply& reply, Time now) {
  const bool same = reply.server_id == followed_;
  if (!same) lag_ = {};
  if (same && reply.seq > answered_seq_) {
    const bool behind = held_ && held_->reply.seq == reply.seq;
    const auto faded = std::chrono::duration_cast<std::chrono::nanoseconds>(kFades * lag_);
    lag_ = std::max(faded, behind ? std::chrono::nanoseconds(now - held_->at) : 0ns);
  }
  followed_ = reply.server_id;
  answered_seq_ = std::max(answered_seq_, reply.seq);
  if (reply.verified()) verified_seq_ = std::max(verified_seq_, reply.seq);
  if (held_ && held_->reply.seq <= answered_seq_) held_.reset();
}

std::optional<SpotReply> ServerChoice::take_overdue(Time now) {
  if (!held_ || now - held_->at < patience()) return std::nullopt;
  const SpotReply reply = std::move(held_->reply);
  held_.reset();
  follow(reply, now);
  return reply;
}

}  // namespace liloc
