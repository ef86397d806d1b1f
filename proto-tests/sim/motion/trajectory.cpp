#include "proto-tests/sim/motion/trajectory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace liloc::sim {
namespace {

using Eigen::Vector3d;
using Vector6 = Trajectory::Vector6;
constexpr double kTurn = 2 * std::numbers::pi;

/// The weights of a uniform B-spline of that degree at share `u` of a knot interval (Cox - de Boor).
template <int Degree>
std::array<double, Degree + 1> weights(double u) {
  if constexpr (Degree == 0) {
    return {1.0};
  } else {
    const auto lower = weights<Degree - 1>(u);
    std::array<double, Degree + 1> w{};
    for (std::size_t j = 0; j < lower.size(); ++j) {
      const auto k = static_cast<double>(j);
      w[j] += (k + 1 - u) / Degree * lower[j];
      w[j + 1] += (Degree - k - 1 + u) / Degree * lower[j];
    }
    return w;
  }
}

/// Body axes x forward, y left, z up; optical axes x right, y down, z forward.
Eigen::Matrix3d body_from_optical() {
  Eigen::Matrix3d R;
  R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return R;
}

/// Mean over +-`half` neighbours, in each channel; the ends repeat.
std::vector<Vector6> smoothed(const std::vector<Vector6>& in, int half) {
  std::vector<Vector6> out(in.size());
  const int last = static_cast<int>(in.size()) - 1;
  for (int i = 0; i <= last; ++i) {
    Vector6 sum = Vector6::Zero();
    for (int k = -half; k <= half; ++k) sum += in[static_cast<std::size_t>(std::clamp(i + k, 0, last))];
    out[static_cast<std::size_t>(i)] = sum / (2 * half + 1);
  }
  return out;
}

/// A slow wander: three sines of random phase, about +-1.
struct Wander {
  explicit Wander(Random& random, double slowest_s) {
    for (int i = 0; i < 3; ++i) {
      rate[i] = kTurn / (slowest_s / (1 + 0.7 * i) * random.uniform(0.8, 1.2));
      phase[i] = random.uniform(0, kTurn);
    }
  }
  [[nodiscard]] double at(double t) const {
    return 0.6 * std::sin(rate[0] * t + phase[0]) + 0.3 * std::sin(rate[1] * t + phase[1]) +
           0.2 * std::sin(rate[2] * t + phase[2]);
  }
  double rate[3], phase[3];
};

/// Who carries a device shows it the room: it turns some way towards the middle, less the nearer that is.
void draw_gaze(std::vector<Vector6>& controls, const Eigen::Vector2d& middle) {
  for (Vector6& c : controls) {
    const Eigen::Vector2d to_middle = middle - c.head<2>();
    const double pull = 0.6 * std::clamp(0.5 * (to_middle.norm() - 0.5), 0.0, 1.0);
    c[3] += pull * std::sin(std::atan2(to_middle.y(), to_middle.x()) - c[3]);
  }
}

/// What a hand adds while one walks: `share` 0 standing, 1 at full pace.
void add_gait(std::vector<Vector6>& controls, const std::vector<double>& share, Random& random) {
  const Wander gaze(random, 9), nod(random, 5), tilt(random, 6);
  const double step_hz = random.uniform(1.6, 2.0), bob_m = random.uniform(0.025, 0.05);  // smoothing halves it
  double stride = 0;
  for (std::size_t i = 0; i < controls.size(); ++i) {
    const double t = static_cast<double>(i) * kWalkStep_s, s = share[i];
    stride += kTurn * step_hz * kWalkStep_s * std::min(1.0, 2 * s);
    controls[i][0] +=
        0.012 * s * std::sin(0.5 * stride) * -std::sin(controls[i][3]);  // sway to the side, every two steps
    controls[i][1] += 0.012 * s * std::sin(0.5 * stride) * std::cos(controls[i][3]);
    controls[i][2] += s * bob_m * std::sin(stride);
    controls[i][3] += s * (0.35 * gaze.at(t) + 0.02 * std::sin(0.5 * stride));
    controls[i][4] += s * (0.035 * nod.at(t) + 0.008 * std::sin(stride + 1));
    controls[i][5] += s * (0.03 * tilt.at(t) + 0.01 * std::sin(0.5 * stride));
  }
}

}  // namespace

MotionState Trajectory::at(double time_s) const {
  const double position = std::max(0.0, time_s / step_s_);
  const auto knot = static_cast<std::ptrdiff_t>(position);
  const double u = position - static_cast<double>(knot);
  std::array<Vector6, 6> c;
  for (std::ptrdiff_t i = 0; i < 6; ++i)
    c[static_cast<std::size_t>(i)] = controls_[static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(knot + i - 2, 0, static_cast<std::ptrdiff_t>(controls_.size()) - 1))];
  const auto w5 = weights<5>(u);
  const auto w4 = weights<4>(u);
  const auto w3 = weights<3>(u);
  Vector6 value = Vector6::Zero(), first = Vector6::Zero(), second = Vector6::Zero();
  for (std::size_t i = 0; i < 6; ++i) value += w5[i] * c[i];
  for (std::size_t i = 0; i < 5; ++i) first += w4[i] * (c[i + 1] - c[i]) / step_s_;
  for (std::size_t i = 0; i < 4; ++i) second += w3[i] * (c[i + 2] - 2 * c[i + 1] + c[i]) / (step_s_ * step_s_);

  const double yaw = value[3], pitch = value[4], roll = value[5];
  const Eigen::Matrix3d R_map_body =
      (Eigen::AngleAxisd(yaw, Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Vector3d::UnitY()) *
       Eigen::AngleAxisd(roll, Vector3d::UnitX()))
          .toRotationMatrix();
  const double yaw_rate = first[3], pitch_rate = first[4], roll_rate = first[5];
  const Vector3d turn_body(roll_rate - yaw_rate * std::sin(pitch),
                           pitch_rate * std::cos(roll) + yaw_rate * std::cos(pitch) * std::sin(roll),
                           yaw_rate * std::cos(pitch) * std::cos(roll) - pitch_rate * std::sin(roll));
  MotionState state;
  state.T_map_sensor = Pose::Identity();
  state.T_map_sensor.linear() = R_map_body * body_from_optical();
  state.T_map_sensor.translation() = value.head<3>();
  state.velocity_m_s = first.head<3>();
  state.acceleration_m_s2 = second.head<3>();
  state.turn_rate_sensor_rad_s = body_from_optical().transpose() * turn_body;
  return state;
}

Trajectory sensor_trajectory(Random& random, const Walk& walk, Carriage carriage, const Eigen::Vector2d& middle,
                             double height_m, double still_s) {
  const double tilt_down =
      carriage == Carriage::hand ? random.uniform(0.03, 0.09) : 0.06;  // positive pitch looks down
  const double lean = carriage == Carriage::hand ? 0.03 * random.normal() : 0.0;
  std::vector<Vector6> controls;
  std::vector<double> share;
  for (const WalkState& state : walk) {
    Vector6 c;
    c << state.at.x(), state.at.y(), height_m, state.yaw_rad, tilt_down, lean;
    controls.push_back(c);
  }
  const int half = carriage == Carriage::hand ? 2 : 3;
  controls = smoothed(smoothed(controls, half), half);
  for (std::size_t i = 0; i < walk.size(); ++i) {  // fades in after the still phase, and follows the pace
    const double moving_s = std::max(0.0, static_cast<double>(i) * kWalkStep_s - still_s);
    share.push_back(std::min(1.0, moving_s) * std::clamp(walk[i].speed_m_s + 0.3, 0.0, 1.0));
  }
  if (carriage == Carriage::hand) draw_gaze(controls, middle);
  if (carriage == Carriage::hand) add_gait(controls, share, random);
  controls = smoothed(controls, 1);
  const auto still = std::min(controls.size(), static_cast<std::size_t>(still_s / kWalkStep_s) + 4);
  for (std::size_t i = 0; i + 1 < still; ++i) controls[i] = controls[still - 1];
  return {std::move(controls), kWalkStep_s};
}

}  // namespace liloc::sim
