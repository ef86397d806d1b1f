#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "common/protocol/spot.hpp"

namespace liloc {

/// When the next global registration is due, by the stamps of the frames alone (paper, section 5.3): at the
/// first usable frame, then every interval, and at once after a stretch of non-informative frames.
class RequestSchedule {
 public:
  RequestSchedule(StampNs interval_ns, StampNs reply_timeout_ns)
      : interval_ns_(interval_ns), reply_timeout_ns_(reply_timeout_ns) {}

  /// To be called once per frame; true when this frame is to be sent.
  [[nodiscard]] bool due(StampNs stamp_ns, bool informative);
  /// A request left / was answered.
  void sent(std::uint64_t seq, StampNs stamp_ns) { pending_.push_back({seq, stamp_ns}); }
  void answered(std::uint64_t seq);
  /// The requests that have waited too long at `stamp_ns`; each is named once.
  [[nodiscard]] std::vector<std::uint64_t> take_unanswered(StampNs stamp_ns);

 private:
  struct Pending {
    std::uint64_t seq;
    StampNs stamp_ns;
  };
  StampNs interval_ns_, reply_timeout_ns_;
  std::optional<StampNs> last_ns_;
  bool after_gap_ = false;
  std::vector<Pending> pending_;
};

}  // namespace liloc
