#pragma once
#include <deque>
#include <optional>

#include "common/base/stamp.hpp"

namespace liloc {

/// One request and its reply: by the device's clock and by the ceiling's, as the server reads it.
struct ClockExchange {
  StampNs sent_ns = 0;             ///< device
  StampNs server_received_ns = 0;  ///< ceiling
  StampNs server_sent_ns = 0;      ///< ceiling
  StampNs received_ns = 0;         ///< device
};

struct ClockOffset {
  StampNs offset_ns = 0;      ///< device clock minus ceiling clock
  StampNs round_trip_ns = 0;  ///< of the exchange it is from, without the server's work
  bool good = false;          ///< several quick exchanges agree
};

/// How far the device's clock runs ahead of the ceiling's. Of the recent exchanges the quickest one counts:
/// delay is what makes the others wrong. Not thread-safe.
class ClockEstimator {
 public:
  /// Implausible exchanges are left out. True when the clocks have jumped against each other: the estimate then
  /// starts anew.
  bool add(const ClockExchange& exchange);
  void reset();
  /// Empty before the first exchange.
  [[nodiscard]] std::optional<ClockOffset> offset() const;
  /// A frame's stamp by the ceiling's clock; empty where the device's own stamp serves as well or better: the
  /// estimate is not good, or the offset is small against what it may be wrong by.
  [[nodiscard]] std::optional<StampNs> ceiling_stamp(StampNs device_stamp_ns) const;

 private:
  struct Sample {
    StampNs at_ns, offset_ns, round_trip_ns;
  };
  [[nodiscard]] const Sample& quickest() const;

  std::deque<Sample> recent_;
  int outside_ = 0;  ///< exchanges in a row that contradict the estimate
};

}  // namespace liloc
