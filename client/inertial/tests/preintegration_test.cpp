#include "client/inertial/preintegration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace liloc {
namespace {

using Eigen::Vector3d;

/// A wild swing of half a second, sampled evenly; deterministic.
std::vector<ImuSample> swing(unsigned seed, double rate_hz, double seconds = 0.5) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const Vector3d a(unit(rng), unit(rng), unit(rng)), b(unit(rng), unit(rng), unit(rng));
  std::vector<ImuSample> samples;
  const int n = static_cast<int>(std::lround(seconds * rate_hz));
  for (int i = 0; i <= n; ++i) {
    const double t = i / rate_hz;
    samples.push_back(
        {from_seconds(1 + t), 2 * a * std::cos(5 * t) + b, 3 * b * std::sin(7 * t) + Vector3d(0, 1, 9.8)});
  }
  return samples;
}

ImuBias random_bias(unsigned seed, double gyro, double accel) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> unit;
  return {gyro * Vector3d(unit(rng), unit(rng), unit(rng)), accel * Vector3d(unit(rng), unit(rng), unit(rng))};
}

class PreintegrationLaw : public testing::TestWithParam<unsigned> {};

/// Euler's method with a step so short that it needs no care.
TEST_P(PreintegrationLaw, AgreesWithBruteForceIntegration) {
  const ImuBias bias = random_bias(GetParam(), 0.05, 0.3);
  const Preintegration p = preintegrate(swing(GetParam(), 400), bias);
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Vector3d v = Vector3d::Zero(), x = Vector3d::Zero();
  const auto fine = swing(GetParam(), 100'000);
  for (std::size_t i = 0; i + 1 < fine.size(); ++i) {
    const double dt = to_seconds(fine[i + 1].stamp_ns - fine[i].stamp_ns);
    x += dt * v;
    v += dt * (R * (fine[i].specific_force_m_s2 - bias.accel_m_s2));
    R *= so3_exp(dt * (fine[i].angular_velocity_rad_s - bias.gyro_rad_s));
  }
  EXPECT_NEAR(p.seconds, 0.5, 1e-9);
  EXPECT_LT(so3_log(R.transpose() * p.turn).norm(), 2e-4);
  EXPECT_LT((v - p.velocity).norm(), 5e-4);
  EXPECT_LT((x - p.shift).norm(), 2e-4);
}

TEST_P(PreintegrationLaw, BiasJacobiansAreTheNumericOnes) {
  const auto samples = swing(GetParam(), 200);
  const ImuBias at = random_bias(GetParam(), 0.02, 0.1);
  const Preintegration p = preintegrate(samples, at);
  const double h = 1e-5;
  for (int axis = 0; axis < 3; ++axis) {
    ImuBias gyro = at, accel = at;
    gyro.gyro_rad_s[axis] += h;
    accel.accel_m_s2[axis] += h;
    const Preintegration by_gyro = preintegrate(samples, gyro), by_accel = preintegrate(samples, accel);
    EXPECT_LT((so3_log(p.turn.transpose() * by_gyro.turn) / h - p.turn_by_gyro.col(axis)).norm(), 1e-4);
    EXPECT_LT(((by_gyro.velocity - p.velocity) / h - p.velocity_by_gyro.col(axis)).norm(), 1e-3);
    EXPECT_LT(((by_gyro.shift - p.shift) / h - p.shift_by_gyro.col(axis)).norm(), 1e-3);
    EXPECT_LT(((by_accel.velocity - p.velocity) / h - p.velocity_by_accel.col(axis)).norm(), 1e-6);
    EXPECT_LT(((by_accel.shift - p.shift) / h - p.shift_by_accel.col(axis)).norm(), 1e-6);
  }
}

TEST_P(PreintegrationLaw, OtherBiasesNeedNoNewIntegration) {
  const auto samples = swing(GetParam(), 200);
  const ImuBias other = random_bias(GetParam() + 50, 0.01, 0.1);
  const Preintegration p = preintegrate(samples, {}).with(other), again = preintegrate(samples, other);
  EXPECT_LT(so3_log(p.turn.transpose() * again.turn).norm(), 1e-4);
  EXPECT_LT((p.velocity - again.velocity).norm(), 2e-3);
  EXPECT_LT((p.shift - again.shift).norm(), 5e-4);
}

TEST_P(PreintegrationLaw, TwoHalvesMakeTheWhole) {
  const auto samples = swing(GetParam(), 200);
  const auto middle = samples.begin() + 40;
  const Preintegration whole = preintegrate(samples, {}),
                       first = preintegrate({samples.begin(), middle + 1}, {}),
                       second = preintegrate({middle, samples.end()}, {});
  EXPECT_LT(so3_log(whole.turn.transpose() * first.turn * second.turn).norm(), 1e-12);
  EXPECT_LT((whole.velocity - first.velocity - first.turn * second.velocity).norm(), 1e-12);
  EXPECT_LT((whole.shift - first.shift - second.seconds * first.velocity - first.turn * second.shift).norm(),
            1e-12);
}

TEST_P(PreintegrationLaw, CovarianceIsTheSpreadOfNoisySamples) {
  const ImuNoise noise{.gyro_rad_s_sqrt_hz = 1e-3, .accel_m_s2_sqrt_hz = 2e-2};
  const auto exact = swing(GetParam(), 200);
  const Preintegration truth = preintegrate(exact, {}, noise);
  std::mt19937 rng(GetParam());
  std::normal_distribution<double> unit;
  const double per_sample = std::sqrt(200.0);  // from density to one sample
  Eigen::Matrix<double, 9, 9> spread = Eigen::Matrix<double, 9, 9>::Zero();
  constexpr int kRuns = 2000;
  for (int run = 0; run < kRuns; ++run) {
    auto noisy = exact;
    for (ImuSample& s : noisy)
      for (int k = 0; k < 3; ++k) {
        s.angular_velocity_rad_s[k] += noise.gyro_rad_s_sqrt_hz * per_sample * unit(rng);
        s.specific_force_m_s2[k] += noise.accel_m_s2_sqrt_hz * per_sample * unit(rng);
      }
    const Preintegration p = preintegrate(noisy, {}, noise);
    Eigen::Matrix<double, 9, 1> off;
    off << so3_log(truth.turn.transpose() * p.turn), p.velocity - truth.velocity, p.shift - truth.shift;
    spread += off * off.transpose() / kRuns;
  }
  for (int k = 0; k < 9; ++k)
    EXPECT_NEAR(std::sqrt(truth.covariance(k, k) / spread(k, k)), 1.0, 0.1) << "component " << k;
}

INSTANTIATE_TEST_SUITE_P(Seeds, PreintegrationLaw, testing::Range(1U, 7U));

}  // namespace
}  // namespace liloc
