#pragma once
#include <vector>

#include "common/geometry/cloud.hpp"

namespace liloc {

/// A direction that may be against gravity, as far as planes tell.
struct UpHypothesis {
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< unit, in the cloud's frame
  double confidence = 0;  ///< 0..1, for ranking; only a search with it shows if it is right
};

/// Defaults are by hand where nothing else is said.
struct UpOptions {
  /// Where up is expected, e.g. -y of an optical frame held upright; zero: nowhere. Only ranks.
  Eigen::Vector3d expected = -Eigen::Vector3d::UnitY();
  std::size_t most = 4;
};

/// What may be up, best first: the directions of floors and ceilings, and those along walls that meet. Rooms
/// are made of planes at right angles, so the share of normals along or across a direction is the evidence;
/// which of the room's axes is the vertical one is told by what is expected alone. Each direction is the
/// eigenvector that its normals agree on. Empty when there are no normals or nothing is plane. Pure.
[[nodiscard]] std::vector<UpHypothesis> find_up(const Cloud& cloud, const UpOptions& options = {});

/// What is up in a map: z, unless its planes lie across it (a map whose frame is not level); then the direction
/// of planes that is nearest to what the ceiling sensors take for up. `expected`: of them, map frame.
[[nodiscard]] Eigen::Vector3d up_of_map(const Cloud& cloud_map, const Eigen::Vector3d& expected);

}  // namespace liloc
