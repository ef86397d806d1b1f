#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "common/protocol/spot.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct RequestScheduleOptions {
  StampNs interval_ns = kRequestInterval;  ///< upper bound between requests
  /// Lower bound while nothing is verified; 0: a quarter of `interval_ns`. Not under `interval_ns`: no haste.
  StampNs searching_interval_ns = 0;
  StampNs reply_timeout_ns = from_ms(4000);
};

/// When the next global registration is due, by the stamps of the frames alone (paper, section 5.3): at the
/// first usable frame, then every interval, and after a stretch of non-informative frames as soon as the
/// lower bound allows.
///
/// While nothing is verified, an answer brings the next request forward, so that several spots are there soon:
/// one interval long in quick succession, then at gaps that double up to the interval. At least as much time
/// passes between an answer and the next request as the answer took, and a server that is silent or refuses
/// for want of time is asked every interval and no more.
class RequestSchedule {
 public:
  explicit RequestSchedule(RequestScheduleOptions options);

  /// To be called once per frame; true when this frame is to be sent. After frames whose place is not `sure`
  /// the next that is asks at once, but for the lower bound.
  [[nodiscard]] bool due(StampNs stamp_ns, bool informative, bool sure = true);
  /// A request left / was answered, as of the newest frame's stamp.
  void sent(std::uint64_t seq, StampNs stamp_ns);
  void answered(const SpotReply& reply, StampNs now_ns);
  /// A server has come, which may know nothing of this device: the next frame that can asks, but for the lower
  /// bound, and until an answer is verified there is haste as in a search.
  void server_found();
  /// An answer was verified: there is no haste any more.
  void search_ended() { located_ = true; }
  /// The odometry broke: what was verified holds no longer.
  void search_begins();
  /// The requests that have waited too long at `stamp_ns`; each is named once.
  [[nodiscard]] std::vector<std::uint64_t> take_unanswered(StampNs stamp_ns);
  /// The device's clock was set by so much.
  void clock_set(StampNs by_ns);

 private:
  [[nodiscard]] StampNs searching_gap_ns() const;

  struct Pending {
    std::uint64_t seq;
    StampNs stamp_ns;
  };
  RequestScheduleOptions options_;
  std::optional<StampNs> last_ns_;
  std::optional<StampNs> hurried_ns_;          ///< from here on a request is due before the interval is over
  std::optional<StampNs> searching_since_ns_;  ///< stamp of the first request of this search
  StampNs gap_ns_ = 0;                         ///< between the last two requests
  bool after_gap_ = false, after_doubt_ = false, located_ = false;
  bool with_new_server_ = false;  ///< nothing was verified since one came
  std::vector<Pending> pending_;
};

}  // namespace liloc
