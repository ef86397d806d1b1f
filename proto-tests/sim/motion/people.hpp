#pragma once
// Bodies that move: people with swinging limbs, and the hull of a robot.
#include <vector>

#include "proto-tests/sim/base/random.hpp"
#include "proto-tests/sim/motion/walk.hpp"
#include "proto-tests/sim/shapes/mesh.hpp"

namespace liloc::sim {

/// How a visitor of world 2 spends the run.
enum class Posture { walking, standing, sitting };

/// Rigid parts and where each is fixed; part 0 does not swing.
class Body {
 public:
  [[nodiscard]] static Body person(Random& random);  ///< torso with head, two arms, two legs
  [[nodiscard]] static Body visitor(Random& random,
                                    Posture posture);  ///< other shapes; those who stay may gesture
  [[nodiscard]] static Body robot();                   ///< one low hull

  [[nodiscard]] double gesture_hz() const { return gesture_hz_; }  ///< 0: arms swing with the walk alone
  [[nodiscard]] const std::vector<Mesh>& parts() const { return parts_; }
  /// `stride_rad` is the phase of the walk: half a turn a step; `swing` 0 standing, 1 at full pace.
  [[nodiscard]] Pose T_map_part(std::size_t part, const Pose& T_map_body, double stride_rad,
                                double swing) const;

 private:
  std::vector<Mesh> parts_;
  std::vector<Eigen::Vector3d> joints_;  ///< in the body frame: x forward, z up from the floor
  std::vector<double> swings_rad_;       ///< signed amplitude about the body's y axis
  std::vector<double> rests_rad_;        ///< where it swings about; empty: all hang
  double gesture_hz_ = 0;
};

}  // namespace liloc::sim
