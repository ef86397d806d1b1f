#include "client/inertial/inertial.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace liloc {
namespace {

constexpr double kRateHz = 200;

/// Samples of a motion with constant acceleration (world axes) and turn rate (body axes), without gravity.
std::vector<InertialSample> steady(const Eigen::Vector3d& acceleration_world, const Eigen::Vector3d& rate,
                                   double seconds) {
  std::vector<InertialSample> samples;
  for (int i = 0; i <= static_cast<int>(std::lround(seconds * kRateHz)); ++i) {
    const double middle = (i + 0.5) / kRateHz;  // a sample stands for the span up to the next one
    samples.push_back(
        {from_seconds(i / kRateHz), rate, so3_exp(rate * middle).transpose() * acceleration_world});
  }
  return samples;
}

class AlgorithmOneLaw : public testing::TestWithParam<unsigned> {};

TEST_P(AlgorithmOneLaw, IntegratesConstantAccelerationAndTurnExactly) {
  std::mt19937 rng(GetParam());
  std::normal_distribution<double> unit;
  const auto random = [&] { return Eigen::Vector3d(unit(rng), unit(rng), unit(rng)); };
  const Eigen::Vector3d a = random(), w = random(), v = random();
  const double t = 0.5;
  const InertialMotion motion = initial_transform(steady(a, w, t), v);
  EXPECT_LT((motion.T_start_end.translation() - (v * t + 0.5 * a * t * t)).norm(), 2e-5);
  EXPECT_LT((motion.velocity_end_m_s - (v + a * t)).norm(), 1e-5);
  EXPECT_LT(so3_log(motion.T_start_end.linear().transpose() * so3_exp(w * t)).norm(), 1e-9);
}

TEST_P(AlgorithmOneLaw, TwoSpansMakeTheWhole) {
  std::mt19937 rng(GetParam());
  std::normal_distribution<double> unit;
  std::vector<InertialSample> all;
  for (int i = 0; i < 41; ++i)
    all.push_back({from_seconds(i / kRateHz), Eigen::Vector3d(unit(rng), unit(rng), unit(rng)),
                   Eigen::Vector3d(unit(rng), unit(rng), unit(rng))});
  const Eigen::Vector3d v(0.3, -0.2, 0.1);
  const InertialMotion whole = initial_transform(all, v);
  const InertialMotion first = initial_transform({all.begin(), all.begin() + 21}, v);
  const Eigen::Matrix3d R = first.T_start_end.linear();
  const InertialMotion second =
      initial_transform({all.begin() + 20, all.end()}, R.transpose() * first.velocity_end_m_s);
  EXPECT_LT(distance_m(first.T_start_end * second.T_start_end, whole.T_start_end), 1e-9);
  EXPECT_LT(angle_between_rad(first.T_start_end * second.T_start_end, whole.T_start_end), 1e-9);
  EXPECT_LT((R * second.velocity_end_m_s - whole.velocity_end_m_s).norm(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Seeds, AlgorithmOneLaw, testing::Range(1U, 17U));

TEST(Inertial, ACircleCloses) {
  // Centripetal acceleration of 1 m/s on a circle of 0.5 m: one turn in pi seconds.
  std::vector<InertialSample> samples;
  const int n = static_cast<int>(std::lround(M_PI * 2000));
  for (int i = 0; i <= n; ++i)
    samples.push_back({from_seconds(i * M_PI / n), Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(0, 2, 0)});
  const InertialMotion turn = initial_transform(samples, {1, 0, 0});
  EXPECT_LT(turn.T_start_end.translation().norm(), 0.002);
  EXPECT_LT((turn.velocity_end_m_s - Eigen::Vector3d(1, 0, 0)).norm(), 0.002);
}

TEST(Smoothing, KeepsAConstantAndALine) {
  std::vector<Eigen::Vector3d> line;
  for (int i = 0; i < 40; ++i) line.emplace_back(1.0, i, -2.0 * i);
  for (const auto& smooth : {gaussian_smoothed(line, 2), moving_average(line, 5)}) {
    ASSERT_EQ(smooth.size(), line.size());
    for (const auto& v : smooth) EXPECT_NEAR(v.x(), 1.0, 1e-12);
    for (std::size_t i = 8; i + 8 < line.size(); ++i) EXPECT_LT((smooth[i] - line[i]).norm(), 1e-9);
  }
}

TEST(Smoothing, TheGaussianHasTheStandardDeviationThatWasAskedFor) {
  std::vector<Eigen::Vector3d> impulse(41, Eigen::Vector3d::Zero());
  impulse[20].x() = 1;
  const auto answer = gaussian_smoothed(impulse, 2);
  double sum = 0, squares = 0;
  for (int i = 0; i < 41; ++i) {
    sum += answer[static_cast<std::size_t>(i)].x();
    squares += answer[static_cast<std::size_t>(i)].x() * (i - 20) * (i - 20);
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
  EXPECT_NEAR(std::sqrt(squares), 2.0, 0.03);  // cut at three deviations
}

}  // namespace
}  // namespace liloc
