#pragma once
// What stands where in a site, at the reference scan and during the run.
#include <optional>
#include <vector>

#include "proto-tests/sim/base/options.hpp"
#include "proto-tests/sim/site/furniture.hpp"

namespace liloc::sim {

struct Placement {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double yaw_rad = 0;
};

/// A piece that slides to another place once during the run.
struct Push {
  double start_s = 0, seconds = 1.5;
  Placement to;
};

struct Item {
  Furniture furniture;
  Placement reference;  ///< when the empty site was scanned
  Placement start;      ///< when the run begins
  std::optional<Push> push;

  [[nodiscard]] Pose T_map_item(double time_s) const;
  [[nodiscard]] Pose T_map_reference() const {
    return upright({reference.at.x(), reference.at.y(), 0}, reference.yaw_rad);
  }
};

struct Layout {
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  ///< inside measures; one corner is the origin
  Mesh room;
  std::vector<Item> items;
};

/// Draws a site for validated options.
[[nodiscard]] Layout make_layout(const SimOptions& options);

/// Whether two upright rectangles come nearer than `gap_m` to each other.
[[nodiscard]] bool too_close(const Placement& a, const Eigen::Vector2d& half_a, const Placement& b,
                             const Eigen::Vector2d& half_b, double gap_m);

}  // namespace liloc::sim
