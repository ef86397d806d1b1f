// The laws that tie trajectory, IMU and depth together.
#include <gmock/gmock.h>

#include "proto-tests/sim/motion/inertial.hpp"
#include "proto-tests/sim/sensors/depth_sensor.hpp"
#include "proto-tests/sim/simulation.hpp"

namespace liloc::sim {
namespace {

SimOptions moving(int seed, DeviceKind kind) {
  SimOptions options;
  options.seed = static_cast<std::uint64_t>(seed);
  options.device_kind = kind;
  options.seconds = 14;
  return options;
}

class MotionLaw : public testing::TestWithParam<std::tuple<int, DeviceKind>> {};

TEST_P(MotionLaw, IntegratingTheExactImuGivesTheTrajectory) {
  const auto simulation = Simulation::create(moving(std::get<0>(GetParam()), std::get<1>(GetParam())));
  ASSERT_TRUE(simulation) << simulation.error().message;
  const Pose T_imu_sensor = *simulation->devices()[0].T_imu_sensor, T_sensor_imu = T_imu_sensor.inverse();
  const double step_s = 0.005;
  Pose T_map_imu = simulation->T_map_sensor(0, 0) * T_sensor_imu;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  for (int i = 0; i < 14 / step_s; ++i) {
    const ImuSample a = simulation->exact_imu(0, i * step_s), b = simulation->exact_imu(0, (i + 1) * step_s);
    const Eigen::Matrix3d R = T_map_imu.linear();
    const Eigen::Matrix3d R_next =
        R * so3_exp(0.5 * step_s * (a.angular_velocity_rad_s + b.angular_velocity_rad_s));
    const Eigen::Vector3d acceleration = 0.5 * (R * a.specific_force_m_s2 + R_next * b.specific_force_m_s2) -
                                         Eigen::Vector3d(0, 0, kGravity_m_s2);
    T_map_imu.translation() += step_s * velocity + 0.5 * step_s * step_s * acceleration;
    velocity += step_s * acceleration;
    T_map_imu.linear() = R_next;
  }
  const Pose truth = simulation->T_map_sensor(0, 14) * T_sensor_imu;
  EXPECT_LT(distance_m(T_map_imu, truth), 0.01);
  EXPECT_LT(degrees(angle_between_rad(T_map_imu, truth)), 0.05);
}

TEST_P(MotionLaw, StandsStillAndThenMovesLikeItsKind) {
  const auto simulation = Simulation::create(moving(std::get<0>(GetParam()), std::get<1>(GetParam())));
  ASSERT_TRUE(simulation) << simulation.error().message;
  EXPECT_LT(distance_m(simulation->T_map_sensor(0, 0), simulation->T_map_sensor(0, 2.99)), 1e-9);
  const bool robot = std::get<1>(GetParam()) == DeviceKind::robot;
  double fastest = 0;
  for (double t = 0; t < 13.9; t += 0.05) {
    const Pose a = simulation->T_map_sensor(0, t), b = simulation->T_map_sensor(0, t + 0.05);
    fastest = std::max(fastest, distance_m(a, b) / 0.05);
    EXPECT_LT(degrees(angle_between_rad(a, b)) / 0.05, 150) << "at " << t;
    EXPECT_NEAR(a.translation().z(), robot ? 0.8 : 1.1, robot ? 1e-9 : 0.15);
  }
  EXPECT_GT(fastest, robot ? 0.1 : 0.4);
  EXPECT_LT(fastest, robot ? 0.6 : 1.5);
}

INSTANTIATE_TEST_SUITE_P(SeedsAndKinds, MotionLaw,
                         testing::Combine(testing::Range(1, 6),
                                          testing::Values(DeviceKind::carried, DeviceKind::robot)));

TEST(Imu, ReadsGravityUpwardsAtRestAndErrorsHaveTheirSize) {
  const auto simulation = Simulation::create(moving(7, DeviceKind::robot));
  ASSERT_TRUE(simulation) << simulation.error().message;
  const ImuSample exact = simulation->exact_imu(0, 1);
  EXPECT_NEAR(exact.specific_force_m_s2.norm(), kGravity_m_s2, 1e-9);
  EXPECT_GT(exact.specific_force_m_s2.z(), 0.98 * kGravity_m_s2) << "the IMU's z axis points up";
  ImuErrors errors(7, 1, 1.0);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
  constexpr int kSamples = 4000;
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector3d off = errors.spoil(exact, 0.005).specific_force_m_s2 - exact.specific_force_m_s2;
    sum += off;
    squares += off.cwiseProduct(off);
  }
  const Eigen::Vector3d mean = sum / kSamples,
                        spread = (squares / kSamples - mean.cwiseProduct(mean)).cwiseSqrt();
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(spread[axis], 0.04, 0.004);
  EXPECT_LT(mean.norm(), 0.3);
}

const Camera kCamera{160, 120, 114, 115, 79.5, 59.5, 0.001};

View wall_view(double distance_m, const Pose& T_map_camera = Pose::Identity()) {
  auto caster = RayCaster::create(1);
  EXPECT_TRUE(caster);
  Mesh wall;
  add_quad(wall, {-50, -50, distance_m}, {100, 0, 0}, {0, 100, 0});
  EXPECT_TRUE(caster->add(wall));
  caster->commit();
  return caster->look(kCamera, T_map_camera, 100);
}

TEST(Depth, OfAFlatWallIsTheSameInEveryPixel) {
  const DepthImage image = sense(wall_view(3.2), {kCamera, 0.2, 9, 0}, 1, 42);
  EXPECT_EQ(image.stamp_ns, 42);
  for (const auto unit : image.units) ASSERT_NEAR(unit, 3200, 1);
}

TEST(Depth, OfASlantedWallFollowsThePinhole) {
  Pose T_map_camera = Pose::Identity();
  T_map_camera.rotate(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()));
  const DepthImage image = sense(wall_view(2.0, T_map_camera), {kCamera, 0.2, 9, 0}, 1, 0);
  for (int v = 0; v < kCamera.height; v += 7)
    for (int u = 0; u < kCamera.width; u += 7) {
      const Eigen::Vector3d ray((u - kCamera.cx) / kCamera.fx, (v - kCamera.cy) / kCamera.fy, 1);
      const double depth = 2.0 / (T_map_camera.linear() * ray).z();
      EXPECT_NEAR(image.at(u, v), 1000 * depth, 1.5) << u << " " << v;
    }
}

TEST(Depth, NoiseAndLossesAreThoseOfTheSensor) {
  for (const auto& [distance_m, sd_m] : {std::pair{1.5, 0.0045}, {4.0, 0.0075}}) {
    const DepthImage image = sense(wall_view(distance_m), {kCamera, 0.2, 9, 1}, 5, 0);
    double sum = 0, squares = 0, seen = 0;
    for (const auto unit : image.units)
      if (unit > 0) {
        const double off = 0.001 * unit - distance_m;
        sum += off;
        squares += off * off;
        ++seen;
      }
    EXPECT_NEAR(sum / seen, 0, 0.0005);
    EXPECT_NEAR(std::sqrt(squares / seen), sd_m, 0.25 * sd_m);
    EXPECT_NEAR(seen / static_cast<double>(image.units.size()), 0.988, 0.006);
  }
}

TEST(Depth, EndsAtTheRangeAlongTheRay) {
  const DepthImage image = sense(wall_view(8.5), {kCamera, 0.2, 9, 0}, 1, 0);
  EXPECT_EQ(image.at(80, 60), 8500);
  EXPECT_EQ(image.at(0, 0), 0) << "the corner's ray is longer than 9 m";
}

}  // namespace
}  // namespace liloc::sim
