#include "common/registration/climber.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace liloc {

struct Climber::Turned {
  std::vector<Eigen::Vector3f> points;
  std::vector<int> planes;
};

Climber::Turned Climber::turned(double yaw_rad, std::size_t points) const {
  const Eigen::Matrix3f R = Eigen::AngleAxisd(yaw_rad, up_map_).toRotationMatrix().cast<float>();
  Turned result;
  const std::size_t count = std::min(points, level_.size());
  result.points.reserve(count);
  result.planes.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    result.points.emplace_back(R * level_.points[i]);
    result.planes.push_back(ScoreField::plane_of(R * level_.normals[i]));
  }
  return result;
}

int Climber::score(const Turned& turned, const Eigen::Vector4d& pose) const {
  const Eigen::Vector3f t = pose.head<3>().cast<float>();
  int sum = 0;
  for (std::size_t i = 0; i < turned.points.size(); ++i) {
    const Eigen::Vector3f p = turned.points[i] + t;
    const int worth = field_.at(p, turned.planes[i]);
    if (worth >= 0 || !moving_.at(p)) sum += worth;
  }
  return sum;
}

bool Climber::improve(double shift_m, double turn_rad, std::size_t points, Turned* at, LevelPose* best) const {
  bool improved = false;
  for (int axis = 0; axis < 4; ++axis)
    for (const double sign : {1.0, -1.0}) {
      LevelPose next = *best;
      next.pose[axis] += sign * (axis == 3 ? turn_rad : shift_m);
      Turned turned_next;
      if (axis == 3) turned_next = turned(next.pose[3], points);
      next.score = score(axis == 3 ? turned_next : *at, next.pose);
      if (next.score <= best->score) continue;
      *best = next;
      if (axis == 3) *at = std::move(turned_next);
      improved = true;
      break;
    }
  return improved;
}

LevelPose Climber::climb(const Eigen::Vector4d& from, const Steps& steps) const {
  Turned at = turned(from[3], steps.points);
  LevelPose best{from, score(at, from)};
  double shift_m = steps.shift_m, turn_rad = steps.turn_rad;
  for (int halving = 0; halving <= steps.halvings; ++halving, shift_m /= 2, turn_rad /= 2)
    for (int round = 0; round < steps.rounds && improve(shift_m, turn_rad, steps.points, &at, &best); ++round) {
    }
  return best;
}

}  // namespace liloc
