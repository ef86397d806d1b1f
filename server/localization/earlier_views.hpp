#pragma once
// What moves before a device: where its points now are, it has looked through a moment ago.
#include <cstdint>
#include <deque>
#include <vector>

#include "common/protocol/spot.hpp"
#include "common/registration/sight/sight.hpp"

namespace liloc {

/// The last views of one device. Somebody who walks before it is no part of the room: the ceiling, which sees
/// him a moment earlier or later, contradicts him in the right place as well. DECISIONS.md. Not thread-safe.
class EarlierViews {
 public:
  /// Of a request's points (sensor frame), by index, those in space that an earlier view of the same segment
  /// looked through. Empty where they are so many that odometry is likelier to be wrong.
  [[nodiscard]] std::vector<std::uint32_t> moving(const SpotRequest& request, const Cloud& cloud_sensor) const;
  /// Remembers the request's view.
  void add(const SpotRequest& request, SightView view);

 private:
  struct Seen {
    SightView view;
    Pose T_odom_sensor;
    StampNs stamp_ns;
    std::uint32_t segment;
  };
  std::deque<Seen> seen_;  ///< newest last
};

}  // namespace liloc
