#include "client/inertial/inertial.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace liloc {
namespace {

/// Weighted mean around each value with kernel(offset), over offsets -reach..reach.
template <class Kernel>
std::vector<Eigen::Vector3d> filtered(const std::vector<Eigen::Vector3d>& values, int reach, Kernel&& kernel) {
  const int n = static_cast<int>(values.size());
  std::vector<Eigen::Vector3d> smooth(values.size());
  for (int i = 0; i < n; ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weights = 0;
    for (int k = std::max(0, i - reach); k <= std::min(n - 1, i + reach); ++k) {
      const double w = kernel(k - i);
      sum += w * values[static_cast<std::size_t>(k)];
      weights += w;
    }
    smooth[static_cast<std::size_t>(i)] = sum / weights;
  }
  return smooth;
}

}  // namespace

InertialMotion initial_transform(const std::vector<InertialSample>& samples,
                                 const Eigen::Vector3d& velocity_m_s) {
  assert(samples.size() >= 2);
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero(), velocity = velocity_m_s;
  for (std::size_t t = 0; t + 1 < samples.size(); ++t) {
    const double dt = to_seconds(samples[t + 1].stamp_ns - samples[t].stamp_ns);
    const Eigen::Matrix3d turn_half = so3_exp(0.5 * dt * samples[t].angular_velocity_rad_s);
    const Eigen::Vector3d a = rotation * turn_half * samples[t].acceleration_m_s2;
    translation += velocity * dt + 0.5 * a * dt * dt;
    velocity += a * dt;
    rotation = rotation * turn_half * turn_half;
  }
  InertialMotion motion;
  motion.T_start_end.linear() = rotation;
  motion.T_start_end.translation() = translation;
  motion.velocity_end_m_s = velocity;
  return motion;
}

std::vector<Eigen::Vector3d> gaussian_smoothed(const std::vector<Eigen::Vector3d>& values, double sd_samples) {
  const double scale = -0.5 / (sd_samples * sd_samples);
  return filtered(values, static_cast<int>(std::ceil(3 * sd_samples)),
                  [scale](int offset) { return std::exp(scale * offset * offset); });
}

std::vector<Eigen::Vector3d> moving_average(const std::vector<Eigen::Vector3d>& values, int window) {
  return filtered(values, window / 2, [](int) { return 1.0; });
}

}  // namespace liloc
