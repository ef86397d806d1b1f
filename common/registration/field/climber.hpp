#pragma once
#include <Eigen/Core>
#include <unordered_map>
#include <vector>

#include "common/registration/field/score_field.hpp"

namespace liloc {

/// A level pose on a field: x, y, z in metres, yaw about the map's up in radians, and what it scores.
struct LevelPose {
  Eigen::Vector4d pose = Eigen::Vector4d::Zero();
  int score = 0;
};

/// Climbs level poses on a field, axis by axis. It remembers the points as turned by each yaw that it has
/// tried, which is nothing but time saved; one thread. The field and the mask of where somebody moves (null:
/// nowhere) outlive it.
class Climber {
 public:
  /// Points about the device and their normals, turned into the map's axes at yaw 0.
  Climber(const ScoreField& field, const VoxelMask* dynamic_mask, const Eigen::Vector3d& up_map,
          const Cloud& level)
      : field_(field),
        dynamic_mask_(dynamic_mask),
        up_map_(up_map),
        level_(level),
        worths_(level.size()),
        against_(level.size()) {}

  struct Steps {
    double shift_m = 0.1, turn_rad = 0.0436;  ///< at first
    int halvings = 2, rounds = 6;             ///< rounds at most, per size of step
    std::size_t points = 240;                 ///< of the points, the first so many
  };
  [[nodiscard]] LevelPose climb(const Eigen::Vector4d& from, const Steps& steps);

 private:
  [[nodiscard]] const ScoreField::Probes& turned(double yaw_rad);
  /// Exact where it exceeds `least`; else any value up to that.
  [[nodiscard]] int score(const Eigen::Vector4d& pose, std::size_t points, int least);
  bool improve(double shift_m, double turn_rad, std::size_t points, LevelPose* best);

  const ScoreField& field_;
  const VoxelMask* const dynamic_mask_;
  const Eigen::Vector3d up_map_;
  const Cloud& level_;
  std::unordered_map<long, ScoreField::Probes> turned_;  ///< by yaw in microradians
  std::vector<std::int32_t> worths_;
  std::vector<std::uint32_t> against_;  ///< points that count against a pose
};

}  // namespace liloc
