#include "client/session/clock_estimator.hpp"

#include <algorithm>
#include <cstdlib>

namespace liloc {
namespace {

// Exchanges: about 20 s at the usual interval. By hand, as all here.
constexpr std::size_t kWindow = 24, kFewest = 2;
constexpr StampNs kSlowest = from_ms(2000);      // an exchange slower than this says nothing
constexpr StampNs kGoodRoundTrip = from_ms(60);  // half of it is what the offset may be wrong by
constexpr StampNs kContradiction = from_ms(20);  // beyond both exchanges' bounds
constexpr int kContradictions = 2;               // in a row: the clocks jumped
constexpr StampNs kWorthwhile = from_ms(15);     // frames of a room a few ms apart are the same

}  // namespace

const ClockEstimator::Sample& ClockEstimator::quickest() const {
  return *std::min_element(recent_.begin(), recent_.end(),
                           [](const Sample& a, const Sample& b) { return a.round_trip_ns < b.round_trip_ns; });
}

bool ClockEstimator::add(const ClockExchange& e) {
  const StampNs round_trip = (e.received_ns - e.sent_ns) - (e.server_sent_ns - e.server_received_ns);
  if (e.sent_ns <= 0 || e.server_received_ns <= 0 || e.server_sent_ns < e.server_received_ns ||
      e.received_ns < e.sent_ns || round_trip > kSlowest || round_trip < -kContradiction)
    return false;
  const StampNs offset = ((e.sent_ns - e.server_received_ns) + (e.received_ns - e.server_sent_ns)) / 2;
  const Sample sample{e.received_ns, offset, std::max<StampNs>(round_trip, 0)};
  bool jumped = false;
  if (!recent_.empty()) {
    const Sample& best = quickest();
    const StampNs bound = (sample.round_trip_ns + best.round_trip_ns) / 2 + kContradiction;
    outside_ = std::abs(sample.offset_ns - best.offset_ns) > bound ? outside_ + 1 : 0;
    jumped = outside_ >= kContradictions;
  }
  if (jumped) reset();
  recent_.push_back(sample);
  if (recent_.size() > kWindow) recent_.pop_front();
  return jumped;
}

void ClockEstimator::reset() {
  recent_.clear();
  outside_ = 0;
}

std::optional<ClockOffset> ClockEstimator::offset() const {
  if (recent_.empty()) return std::nullopt;
  const Sample& best = quickest();
  const bool good = recent_.size() >= kFewest && best.round_trip_ns <= kGoodRoundTrip && outside_ == 0;
  return ClockOffset{best.offset_ns, best.round_trip_ns, good};
}

std::optional<StampNs> ClockEstimator::ceiling_stamp(StampNs device_stamp_ns) const {
  const auto now = offset();
  if (!now || !now->good) return std::nullopt;
  if (std::abs(now->offset_ns) <= now->round_trip_ns / 2 + kWorthwhile) return std::nullopt;
  return device_stamp_ns - now->offset_ns;
}

}  // namespace liloc
