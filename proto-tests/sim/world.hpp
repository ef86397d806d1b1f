#pragma once
// All bodies of a simulated site and where they are at a time.
#include "proto-tests/sim/motion/inertial.hpp"
#include "proto-tests/sim/motion/people.hpp"
#include "proto-tests/sim/shapes/ray_caster.hpp"
#include "proto-tests/sim/site/layout.hpp"

namespace liloc::sim {

class World {
 public:
  /// Errors: the site is too crammed to walk in, or Embree cannot start.
  [[nodiscard]] static Result<World> create(const SimOptions& options);

  [[nodiscard]] const Layout& layout() const { return layout_; }
  [[nodiscard]] const std::vector<Trajectory>& devices() const { return devices_; }
  /// What a camera at that place sees at that time since the start. Not thread-safe.
  [[nodiscard]] View look(double time_s, const Camera& camera, const Pose& T_map_camera, double range_m);

 private:
  struct Mover {
    Body body;
    std::vector<std::size_t> numbers;  ///< of its parts in the ray caster
    Walk walk;
    std::vector<double> stride_rad;  ///< per step of the walk
    int device = -1;                 ///< whose carrier it is, or -1
  };

  World(Layout layout, RayCaster caster) : layout_(std::move(layout)), caster_(std::move(caster)) {}
  [[nodiscard]] Status add_furniture();
  [[nodiscard]] Status add_mover(Body body, Walk walk, int device);
  [[nodiscard]] Status populate(const SimOptions& options);
  void move_to(double time_s);
  void pose(const Mover& mover, double time_s);

  Layout layout_;
  RayCaster caster_;
  std::vector<std::size_t> item_numbers_;  ///< of pushed items alone
  std::vector<std::size_t> pushed_items_;
  std::vector<Mover> movers_;
  std::vector<Trajectory> devices_;
  double posed_at_s_ = -1;
};

}  // namespace liloc::sim
