#pragma once
// What a server tells about itself once a second, for tables and dashboards.
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/stamp.hpp"
#include "common/protocol/spot.hpp"
#include "common/wire/dds/dispatcher.hpp"

namespace liloc::wire {

/// blind: frames without returns; implausible: ranges that no ceiling LiDAR sees, or three times what it used
/// to see; clock_off: its clock is not the site's and cannot be corrected (yet), so its frames are left out.
enum class LidarState : std::uint8_t {
  waiting = 0,
  ok = 1,
  slow = 2,
  silent = 3,
  malformed = 4,
  blind = 5,
  implausible = 6,
  clock_off = 7
};
[[nodiscard]] std::string_view name_of(LidarState state);
/// Its frames count.
[[nodiscard]] constexpr bool is_heard(LidarState state) {
  return state == LidarState::ok || state == LidarState::slow;
}

struct LidarHealth {
  std::string id;
  LidarState state = LidarState::waiting;  ///< waiting: nothing has come yet
  double measured_hz = 0;
  std::uint64_t frames = 0, malformed = 0;
  std::string last_error = {};   ///< at most 200 characters
  double returns = 0;            ///< share of the pixels that measured something, 0..1
  double range_m = 0;            ///< median depth of these; 0: none
  double usual_range_m = 0;      ///< what that used to be; 0: not known yet
  double clock_offset_s = 0;     ///< its clock ahead of the site's
  bool clock_corrected = false;  ///< its stamps are set right by that
};

struct ServerStatus {
  std::string server_id;
  StampNs stamp_ns = 0;
  double uptime_s = 0;
  std::vector<LidarHealth> lidars;  ///< at most 64
  std::uint32_t clients = 0, queued = 0;
  std::uint64_t answered = 0, verified = 0, refused = 0;  ///< since the start; answered counts every reply
  std::vector<CloudCodec> codecs;                         ///< of clouds, that it reads; empty: it does not say
};

class StatusPublisher {
 public:
  [[nodiscard]] static Result<StatusPublisher> create(const Participant& participant);
  [[nodiscard]] Status publish(const ServerStatus& status) const;

 private:
  explicit StatusPublisher(std::vector<Entity> entities) : entities_(std::move(entities)) {}
  std::vector<Entity> entities_;
};

[[nodiscard]] Status subscribe_status(Dispatcher& dispatcher,
                                      std::function<void(Result<ServerStatus>)> handler);

}  // namespace liloc::wire
