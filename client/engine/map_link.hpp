#pragma once
#include <optional>

#include "common/protocol/spot.hpp"

namespace liloc {

/// coasting: located once, the server is silent; lost: located once, but the pose may be anywhere by now.
enum class Tracking { searching, tracking, coasting, lost };

/// Where odometry lies in the map (REP-105: corrections move map -> odom, odometry itself stays continuous).
class MapLink {
 public:
  explicit MapLink(StampNs silent_after_ns) : silent_after_ns_(silent_after_ns) {}

  /// Takes an answer over if it is verified and of the current segment; true when it moved map -> odom.
  bool add(const SpotReply& reply, std::uint32_t segment);
  /// The newest verified link. After a break of the odometry the old one stays in use, bridged by the guess.
  [[nodiscard]] const std::optional<Pose>& T_map_odom() const { return T_map_odom_; }
  /// Whether an answer of this segment was verified.
  [[nodiscard]] bool located(std::uint32_t segment) const {
    return T_map_odom_ && segment == verified_segment_;
  }
  /// The device's clock was set by so much.
  void clock_set(StampNs by_ns);
  [[nodiscard]] Tracking tracking(StampNs now_ns, std::uint32_t segment) const;

 private:
  StampNs silent_after_ns_;
  std::optional<Pose> T_map_odom_;
  std::uint32_t verified_segment_ = 0;
  StampNs answered_ns_ = 0;  ///< stamp of the newest request that got a pose
  StampNs verified_ns_ = 0;  ///< and of the newest verified one
};

}  // namespace liloc
