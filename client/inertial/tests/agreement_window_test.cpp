#include <gtest/gtest.h>

#include "client/inertial/imu_agreement.hpp"

namespace liloc {
namespace {

constexpr double kRate_rad_s = 0.5;  // 0.05 rad over the shortest step here: enough to be compared

/// An IMU that turns for the first steps and then stands; registration sees `seen_factor` of it.
class Turning {
 public:
  Turning(StampNs step_ns, double seen_factor) : step_ns_(step_ns), seen_factor_(seen_factor) {}
  Turning& turn(int steps) { return go(steps, kRate_rad_s); }
  Turning& stand(int steps) { return go(steps, 0); }
  [[nodiscard]] const MotionRecord& record() const { return record_; }

 private:
  Turning& go(int steps, double rate_rad_s) {
    for (int i = 0; i < steps; ++i, now_ns_ += step_ns_) {
      const StampNs end_ns = now_ns_ + step_ns_;
      for (; felt_ns_ <= end_ns + from_ms(10); felt_ns_ += from_ms(10)) feel(rate_rad_s);  // past its end
      SeenStep step{now_ns_, end_ns};
      step.rate_rad_s = {0, 0, seen_factor_ * rate_rad_s};
      record_.see(step);
    }
    return *this;
  }
  void feel(double rate_rad_s) {
    ImuSample sample;
    sample.stamp_ns = felt_ns_;
    sample.angular_velocity_rad_s = {0, 0, rate_rad_s};
    record_.feel(sample);
  }

  const StampNs step_ns_;
  const double seen_factor_;
  StampNs now_ns_ = from_ms(1000), felt_ns_ = from_ms(1000);
  MotionRecord record_;
};

Agreement judged(const Turning& turning) {
  return gyro_agreement(turning.record(), Eigen::Vector3d::Zero());
}

TEST(GyroAgreement, OpposedTurnsContradictAndTheSameAgree) {
  EXPECT_EQ(judged(Turning(from_ms(100), -1).turn(6)), Agreement::contradicts);
  EXPECT_EQ(judged(Turning(from_ms(100), 1).turn(10)), Agreement::agrees);
  EXPECT_EQ(judged(Turning(from_ms(100), 1).turn(9)), Agreement::unknown);
  EXPECT_EQ(judged(Turning(from_ms(100), -1).stand(20)), Agreement::unknown);
}

/// Four contradicting steps are needed: the verdict goes when the first of them is `age` of these steps old.
void expect_window_of(int age, StampNs step_ns) {
  EXPECT_EQ(judged(Turning(step_ns, -1).turn(4).stand(age - 4)), Agreement::contradicts) << "within it";
  EXPECT_EQ(judged(Turning(step_ns, -1).turn(4).stand(age - 3)), Agreement::unknown) << "at its border";
}

TEST(GyroAgreement, StepsCountForLessThanThreeSeconds) {
  expect_window_of(30, from_ms(100));
}

TEST(GyroAgreement, TwelveStepsCountWhereFramesAreRare) {
  expect_window_of(12, from_ms(1000));
}

TEST(GyroFactor, CountsTheSameStepsAsTheAgreement) {
  const auto factor = [](int standing) {
    return gyro_factor(Turning(from_ms(100), 1).turn(4).stand(standing).record());
  };
  ASSERT_TRUE(factor(26) && factor(29));
  EXPECT_NEAR(*factor(26), 1, 0.05);
  EXPECT_FALSE(factor(30)) << "it only stood in the last three seconds";
}

}  // namespace
}  // namespace liloc
