#pragma once
#include <Eigen/Core>
#include <vector>

#include "common/registration/moving_mask.hpp"

namespace liloc {

/// A level pose on a field: x, y, z in metres, yaw about the map's up in radians, and what it scores.
struct LevelPose {
  Eigen::Vector4d pose = Eigen::Vector4d::Zero();
  int score = 0;
};

/// Climbs level poses on a field, axis by axis. Pure; the field and the mask outlive it.
class Climber {
 public:
  /// Points about the device and their normals, turned into the map's axes at yaw 0.
  Climber(const ScoreField& field, const MovingMask& moving, const Eigen::Vector3d& up_map, const Cloud& level)
      : field_(field), moving_(moving), up_map_(up_map), level_(level) {}

  struct Steps {
    double shift_m = 0.1, turn_rad = 0.0436;  ///< at first
    int halvings = 2, rounds = 6;             ///< rounds at most, per size of step
    std::size_t points = 240;                 ///< of the points, the first so many
  };
  [[nodiscard]] LevelPose climb(const Eigen::Vector4d& from, const Steps& steps) const;

 private:
  struct Turned;  ///< the points at one yaw
  [[nodiscard]] Turned turned(double yaw_rad, std::size_t points) const;
  [[nodiscard]] int score(const Turned& turned, const Eigen::Vector4d& pose) const;
  bool improve(double shift_m, double turn_rad, std::size_t points, Turned* at, LevelPose* best) const;

  const ScoreField& field_;
  const MovingMask& moving_;
  const Eigen::Vector3d up_map_;
  const Cloud& level_;
};

}  // namespace liloc
