#pragma once
// Fills a room piece by piece; a piece that finds no place is left out.
#include "proto-tests/sim/site/layout.hpp"

namespace liloc::sim {

class Furnisher {
 public:
  /// `symmetric`: each piece gets a twin after half a turn about the room's middle. All references must outlive
  /// it.
  Furnisher(Random& random, const Eigen::Vector3d& size, bool symmetric, std::vector<Item>& items)
      : random_(random), size_(size), symmetric_(symmetric), items_(items) {}

  void along_wall(const Furniture& piece, double gap_m);             ///< with its back to a wall
  void anywhere(const Furniture& piece, double gap_m, bool square);  ///< square: nearly along the walls
  void pillar(const Furniture& piece);                               ///< away from corners and wall middles
  void at_desk(const Furniture& chair, const Item& desk);            ///< in front of it, a little turned
  void at(const Furniture& piece, const Placement& there, double gap_m);  ///< there or nowhere

  /// Whether a piece fits there with so much air about it. `self` is not counted.
  [[nodiscard]] bool fits(const Furniture& piece, const Placement& at, double gap_m,
                          const Item* self = nullptr) const;

 private:
  [[nodiscard]] Placement opposite(const Placement& p) const;
  [[nodiscard]] Eigen::Vector2d somewhere(double from_wall_m);
  [[nodiscard]] bool near_a_lidar(const Eigen::Vector2d& at) const;
  template <class Draw>
  void place(const Furniture& piece, double gap_m, Draw draw);

  Random& random_;
  const Eigen::Vector3d size_;
  const bool symmetric_;
  std::vector<Item>& items_;
};

}  // namespace liloc::sim
