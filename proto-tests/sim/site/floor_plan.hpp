#pragma once
// Where one can walk: a grid of free floor, and ways through it.
#include <cstdint>
#include <vector>

#include "proto-tests/sim/site/layout.hpp"

namespace liloc::sim {

class FloorPlan {
 public:
  /// Floor that a body of `radius_m` can stand on at any time of the run: clear of walls and of each piece of
  /// furniture wherever it stands. Only the largest connected part counts; it may be empty in a crammed site.
  FloorPlan(const Layout& layout, double radius_m);

  [[nodiscard]] bool empty() const { return free_cells_.empty(); }
  [[nodiscard]] bool is_free(const Eigen::Vector2d& at) const;
  [[nodiscard]] Eigen::Vector2d random_place(Random& random) const;
  [[nodiscard]] double distance_to_wall_m(const Eigen::Vector2d& at) const;
  [[nodiscard]] Eigen::Vector2d middle() const { return 0.5 * size_m_; }
  [[nodiscard]] Eigen::Vector2d nearest_free(const Eigen::Vector2d& at) const;
  /// Corners of a short way; straight legs between them are free. Empty when either end is not.
  [[nodiscard]] std::vector<Eigen::Vector2d> route(const Eigen::Vector2d& from,
                                                   const Eigen::Vector2d& to) const;

 private:
  [[nodiscard]] int cell_of(const Eigen::Vector2d& at) const;  ///< -1 outside
  [[nodiscard]] Eigen::Vector2d centre_of(int cell) const;
  [[nodiscard]] bool sees(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;
  void keep_largest_part();

  Eigen::Vector2d size_m_;
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint8_t> free_;  ///< per cell, row by row
  std::vector<int> free_cells_;
};

}  // namespace liloc::sim
