#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/geometry/cloud.hpp"

namespace liloc {

/// What became of a cloud's points. Most of a room stays as it is from one moment to the next.
struct CloudChange {
  static constexpr std::int32_t kGone = -1;
  std::vector<std::int32_t> now;      ///< of each point before: its index now, rising, or kGone
  std::vector<Eigen::Vector3f> gone;  ///< points that are not there any more
  std::vector<std::uint32_t> fresh;   ///< indices of points that were not there before, rising

  /// Whether what is made of `points` points now is made sooner from that of before than anew.
  [[nodiscard]] bool little(std::size_t points) const { return gone.size() <= points / 4; }
};

/// A point stays if its place and normal are the same to the last bit and points that stay keep their order; as
/// many stay as can.
[[nodiscard]] CloudChange change_between(const Cloud& before, const Cloud& now);

}  // namespace liloc
