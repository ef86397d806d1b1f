#include "common/registration/field/climber.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace liloc {

const ScoreField::Probes& Climber::turned(double yaw_rad) {
  const auto [found, fresh] = turned_.try_emplace(std::lround(1e6 * yaw_rad));
  ScoreField::Probes& probes = found->second;
  if (!fresh) return probes;
  const Eigen::Matrix3f R = Eigen::AngleAxisd(yaw_rad, up_map_).toRotationMatrix().cast<float>();
  for (std::size_t i = 0; i < level_.size(); ++i) {
    const Eigen::Vector3f p = R * level_.points[i];
    probes.x.push_back(p.x());
    probes.y.push_back(p.y());
    probes.z.push_back(p.z());
    probes.plane.push_back(ScoreField::plane_of(R * level_.normals[i]));
  }
  return probes;
}

int Climber::score(const Eigen::Vector4d& pose, std::size_t points, int least) {
  const ScoreField::Probes& probes = turned(pose[3]);
  const Eigen::Vector3f t = pose.head<3>().cast<float>();
  const std::span<std::int32_t> worths(worths_.data(), std::min(points, level_.size()));
  field_.look_up(probes, t, worths);
  int sum = 0, most = 0;
  for (const std::int32_t worth : worths) {
    sum += worth;
    most += worth > 0 ? worth : 0;
  }
  if (dynamic_mask_ == nullptr || most <= least) return sum;
  std::size_t count = 0;
  for (std::size_t i = 0; i < worths.size(); ++i) {
    against_[count] = static_cast<std::uint32_t>(i);
    count += worths[i] < 0 ? 1 : 0;
  }
  for (const std::uint32_t i : std::span(against_.data(), count))
    if (dynamic_mask_->at(Eigen::Vector3f(probes.x[i], probes.y[i], probes.z[i]) + t)) sum -= worths[i];
  return sum;
}

bool Climber::improve(double shift_m, double turn_rad, std::size_t points, LevelPose* best) {
  bool improved = false;
  for (int axis = 0; axis < 4; ++axis)
    for (const double sign : {1.0, -1.0}) {
      LevelPose next = *best;
      next.pose[axis] += sign * (axis == 3 ? turn_rad : shift_m);
      next.score = score(next.pose, points, best->score);
      if (next.score <= best->score) continue;
      *best = next;
      improved = true;
      break;
    }
  return improved;
}

LevelPose Climber::climb(const Eigen::Vector4d& from, const Steps& steps) {
  LevelPose best{from, score(from, steps.points, std::numeric_limits<int>::min())};
  double shift_m = steps.shift_m, turn_rad = steps.turn_rad;
  for (int halving = 0; halving <= steps.halvings; ++halving, shift_m /= 2, turn_rad /= 2)
    for (int round = 0; round < steps.rounds && improve(shift_m, turn_rad, steps.points, &best); ++round) {
    }
  return best;
}

}  // namespace liloc
