#include "client/inertial/inertial_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/testing/box_room.hpp"

namespace liloc {
namespace {

using Eigen::Vector3d;

constexpr StampNs kStart = 1'700'000'000'000'000'000;
constexpr double kRateHz = 200, kPoseSdM = 0.002, kPoseSdRad = 0.001;

/// Walks and turns, in an odometry frame that does not know where up is.
Pose walk(double t) {
  const double s = t * t * t / (t * t + 1);
  Pose T_odom_map = Pose::Identity();
  T_odom_map.linear() = so3_exp({0.7, -0.4, 0.2});
  return T_odom_map * scene::looking({3 + 0.8 * std::sin(0.6 * s), 2.5 + 0.6 * std::sin(0.8 * s),
                                      1.2 + 0.03 * std::sin(6 * s)},
                                     0.5 * s, 0.15 + 0.1 * std::sin(s));
}

/// A phone-grade IMU and a registration that sees its pose 15 times a second.
class Ride {
 public:
  explicit Ride(unsigned seed) : rng_(seed) {
    bias.gyro_rad_s = 0.003 * normal3();
    bias.accel_m_s2 = 0.05 * normal3();
    const Eigen::Matrix3d R_map_odom = so3_exp({0.7, -0.4, 0.2}).transpose();
    const auto in_map = [&](double t) {
      Pose T = walk(t);
      T.linear() = R_map_odom * T.linear();
      T.translation() = R_map_odom * T.translation();
      return T;
    };
    samples_ = scene::imu_along(in_map, Pose::Identity(), 0, 21, kRateHz, kStart);
    for (ImuSample& s : samples_) {
      s.angular_velocity_rad_s += bias.gyro_rad_s + 0.003 * normal3();
      s.specific_force_m_s2 += bias.accel_m_s2 + 0.04 * normal3();
    }
    InertialStart start;
    start.T_odom_imu = walk(0);
    start.velocity_sd_m_s = 0.1;
    start.force_m_s2 = samples_.front().specific_force_m_s2;
    start.force_sd_m_s2 = 0.1;
    filter.emplace(start);
  }

  /// To the next frame, 14 samples later.
  void predict() {
    const auto first = samples_.begin() + next_;
    filter->predict({first, first + 15});
    next_ += 14;
  }
  /// What a registration that weighs the prediction would say.
  void measure() {
    const Matrix6d prior = filter->covariance().topLeftCorner<6, 6>();
    Matrix6d noise = Matrix6d::Zero();
    noise.diagonal() << Vector3d::Constant(kPoseSdRad * kPoseSdRad), Vector3d::Constant(kPoseSdM * kPoseSdM);
    Vector6d off = error();
    off.head<3>() += kPoseSdRad * normal3();
    off.tail<3>() += kPoseSdM * normal3();
    const Vector6d step = prior * (prior + noise).inverse() * off;
    Pose T = filter->state().T_odom_imu;
    T.linear() = so3_exp(step.head<3>()) * T.linear();
    T.translation() += step.tail<3>();
    filter->update(T, (prior.inverse() + noise.inverse()).inverse());
  }
  [[nodiscard]] double time() const { return static_cast<double>(next_) / kRateHz; }
  /// Truth minus estimate.
  [[nodiscard]] Vector6d error() const {
    const Pose truth = walk(time()), &T = filter->state().T_odom_imu;
    Vector6d off;
    off << so3_log(truth.linear() * T.linear().transpose()), truth.translation() - T.translation();
    return off;
  }
  [[nodiscard]] Vector3d velocity() const {
    return (walk(time() + 1e-4).translation() - walk(time() - 1e-4).translation()) / 2e-4;
  }

  ImuBias bias;
  std::optional<InertialFilter> filter;

 private:
  Vector3d normal3() { return {unit_(rng_), unit_(rng_), unit_(rng_)}; }
  std::mt19937 rng_;
  std::normal_distribution<double> unit_;
  std::vector<ImuSample> samples_;
  std::ptrdiff_t next_ = 0;
};

class InertialFilterLaw : public testing::TestWithParam<unsigned> {};

TEST_P(InertialFilterLaw, LearnsBiasesVelocityAndGravity) {
  Ride ride(GetParam());
  for (int i = 0; i < 280; ++i) {
    ride.predict();
    ride.measure();
  }
  const InertialState& state = ride.filter->state();
  EXPECT_LT((state.bias.gyro_rad_s - ride.bias.gyro_rad_s).norm(), 0.0015);
  EXPECT_LT((state.bias.accel_m_s2 - ride.bias.accel_m_s2).norm(), 0.06);
  EXPECT_LT((state.velocity_m_s - ride.velocity()).norm(), 0.02);
  const Vector3d down = so3_exp({0.7, -0.4, 0.2}) * Vector3d(0, 0, -9.81);
  EXPECT_LT((state.gravity_m_s2 - down).norm(), 0.05);
}

TEST_P(InertialFilterLaw, AFewBlindFramesCostMillimetres) {
  Ride ride(GetParam());
  for (int i = 0; i < 150; ++i) {
    ride.predict();
    ride.measure();
  }
  for (int i = 0; i < 8; ++i) ride.predict();  // half a second
  EXPECT_LT(ride.error().tail<3>().norm(), 0.03);
  EXPECT_LT(ride.error().head<3>().norm(), 0.005);
}

INSTANTIATE_TEST_SUITE_P(Seeds, InertialFilterLaw, testing::Range(1U, 9U));

/// Normalized error squared over many rides: 6 for a filter that knows how wrong it is.
TEST(InertialFilter, PredictionsErrAsMuchAsTheySay) {
  double sum = 0, velocity_sum = 0;
  int count = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    Ride ride(seed);
    for (int i = 0; i < 60; ++i) {
      ride.predict();
      if (i >= 20) {
        const Vector6d off = ride.error();
        sum += off.dot(ride.filter->covariance().topLeftCorner<6, 6>().ldlt().solve(off));
        const Vector3d v = ride.velocity() - ride.filter->state().velocity_m_s;
        velocity_sum += v.dot(ride.filter->covariance()
                                  .block<3, 3>(InertialFilter::kVelocity, InertialFilter::kVelocity)
                                  .ldlt()
                                  .solve(v));
        ++count;
      }
      ride.measure();
    }
  }
  EXPECT_LT(sum / count, 7.0);
  EXPECT_GT(sum / count, 2.0);  // it allows for more noise than this IMU has
  EXPECT_LT(velocity_sum / count, 3.6);
  EXPECT_GT(velocity_sum / count, 0.8);
}

TEST(InertialFilter, AStartAtRestKnowsTheBiasAlongGravityAlone) {
  InertialStart start;
  start.force_m_s2 = {0, 0, 9.91};
  start.force_sd_m_s2 = 0.01;
  const InertialFilter filter(start);
  EXPECT_NEAR(filter.state().bias.accel_m_s2.z(), 0.1, 0.02);
  EXPECT_NEAR(filter.state().bias.accel_m_s2.x(), 0.0, 1e-9);
  const auto sd = [&](int i) { return std::sqrt(filter.covariance()(i, i)); };
  EXPECT_LT(sd(InertialFilter::kAccelBias + 2), 0.04);
  EXPECT_GT(sd(InertialFilter::kAccelBias), 0.09);
}

}  // namespace
}  // namespace liloc
