// A device's clock that is set, and stamps that are wrong: the engine goes on, and says so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/engine/tests/located_device.hpp"

namespace liloc {
namespace {

using namespace test;
using ::testing::HasSubstr;

/// Once, at the third second.
Device::Stamps once(StampNs off_ns) {
  return [off_ns, done = std::make_shared<bool>(false)](StampNs stamp_ns) {
    if (*done || stamp_ns < kStart + from_seconds(3)) return stamp_ns;
    *done = true;
    return stamp_ns + off_ns;
  };
}

class DeviceClock : public testing::TestWithParam<Inputs> {};

TEST_P(DeviceClock, SetBackIsFollowedWithinAFewFrames) {
  for (const double by_s : {0.8, 10.0, 3600.0, 1e8}) {
    Device device(GetParam());
    device.go(4, right);
    ASSERT_EQ(device.engine.tracking(), Tracking::tracking);
    const std::uint32_t segment = device.frame_.odom_segment;
    device.longest_unlocated_s = 0;
    device.go(4, [&](StampNs stamp) { return stamp - from_seconds(by_s); });
    EXPECT_LE(device.frames_refused, 2) << by_s;
    EXPECT_LE(device.samples_refused, 2);
    EXPECT_GT(device.frame_.odom_segment, segment);
    EXPECT_LT(device.longest_unlocated_s, 0.5);
    EXPECT_LT(device.worst_m, 0.05);
    EXPECT_THAT(device.problems, HasSubstr("clock was set back"));
    EXPECT_EQ(device.engine.tracking(), Tracking::tracking);
    EXPECT_EQ(device.engine.problem(), "");
  }
}

TEST_P(DeviceClock, SetAheadIsFollowedWithinAFewFrames) {
  Device device(GetParam());
  device.go(4, right);
  device.go(4, [](StampNs stamp) { return stamp + from_seconds(3600); });
  EXPECT_LE(device.frames_refused, 2);
  EXPECT_LE(device.samples_refused, 2);
  EXPECT_LT(device.worst_m, 0.05);
  EXPECT_EQ(device.engine.tracking(), Tracking::tracking);
}

TEST_P(DeviceClock, ALoneFrameFarOffIsDropped) {
  for (const double off_s : {3600.0, -3600.0}) {
    Device device(GetParam());
    device.go(6, once(from_seconds(off_s)), right);
    EXPECT_EQ(device.frames_refused, 1);
    EXPECT_EQ(device.frame_.odom_segment, 0U);
    EXPECT_LT(device.worst_m, 0.05);
  }
}

TEST_P(DeviceClock, ALoneSampleFarOffIsDropped) {
  for (const double off_s : {3600.0, -3600.0}) {
    Device device(GetParam());
    device.go(6, right, once(from_seconds(off_s)));
    EXPECT_EQ(device.frames_refused, 0);
    EXPECT_EQ(device.samples_refused, GetParam() == Inputs::imu || GetParam() == Inputs::external ? 1 : 0);
    EXPECT_EQ(device.frame_.odom_segment, 0U);
    EXPECT_LT(device.worst_m, 0.05);
    EXPECT_EQ(device.problems, "");
  }
}

TEST_P(DeviceClock, OtherUnitsAreNamedAndForgottenWhenRight) {
  for (const StampNs divisor : {1'000, 1'000'000}) {
    Device device(GetParam());
    const auto in_unit = [&](StampNs stamp) { return stamp / divisor; };
    device.go(2, in_unit);
    EXPECT_GE(device.frames_refused, 25);
    const auto refused = device.engine.add_depth(scene::render(
        scene::furnished_room(1), walk(2.05), scene::small_camera(), in_unit(kStart + from_seconds(2.05)), 0));
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr(divisor == 1'000 ? "microseconds" : "milliseconds"));
    device.go(4, right);
    EXPECT_EQ(device.engine.tracking(), Tracking::tracking);
    EXPECT_LT(device.worst_m, 0.05);
  }
}
INSTANTIATE_TEST_SUITE_P(
    Of, DeviceClock, testing::Values(Inputs::depth, Inputs::points, Inputs::imu, Inputs::external),
    [](const auto& tested) {
      return std::string(std::array{"depth", "points", "imu", "external"}[static_cast<int>(tested.param)]);
    });

TEST(DeviceClockStamps, ZeroAndNegativeAreRefused) {
  Device device(Inputs::imu);
  for (const StampNs stamp : {StampNs{0}, StampNs{-1}}) {
    EXPECT_THAT(device.engine.add_imu({stamp, {0, 0, 0}, {0, 0, 9.81}}).error().message, HasSubstr("not set"));
    EXPECT_THAT(device.engine.add_points(stamp, {}).error().message, HasSubstr("not set"));
  }
}

struct Wild {
  const char* name;
  Eigen::Vector3d rate_rad_s, force_m_s2;
};
class WildSample : public testing::TestWithParam<Wild> {};

/// One of 400: at 200 Hz each two seconds.
TEST_P(WildSample, IsDroppedAndBridged) {
  Device device(Inputs::imu);
  int count = 0;
  device.spoil = [&](ImuSample& sample) {
    if (++count % 400 != 50) return;
    if (!GetParam().rate_rad_s.isZero()) sample.angular_velocity_rad_s = GetParam().rate_rad_s;
    if (!GetParam().force_m_s2.isZero()) sample.specific_force_m_s2 = GetParam().force_m_s2;
  };
  device.go(8, right);
  EXPECT_EQ(device.samples_refused, 4);
  EXPECT_EQ(device.frame_.odom_segment, 0U);
  EXPECT_LT(device.worst_m, 0.05);
  EXPECT_THAT(device.problems, HasSubstr("no such sensor"));
}
INSTANTIATE_TEST_SUITE_P(Of, WildSample,
                         testing::Values(Wild{"gyro", {0, 300, 0}, {0, 0, 0}},
                                         Wild{"force", {0, 0, 0}, {1000, 0, 0}},
                                         Wild{"both", {-1e4, 0, 1e30}, {1e300, 0, -1e300}}),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(UnknownCovariance, IsNoReasonToThrowThePoseAway) {
  for (const double bad : {static_cast<double>(NAN), static_cast<double>(INFINITY), -1.0}) {
    Device device(Inputs::external);
    device.covariance = Matrix6d(bad * Matrix6d::Identity());
    device.go(4, right);
    EXPECT_EQ(device.samples_refused, 0);
    EXPECT_EQ(device.engine.tracking(), Tracking::tracking);
    EXPECT_LT(device.worst_m, 0.05);
    EXPECT_TRUE(device.frame_.covariance && device.frame_.covariance->allFinite());
  }
}

}  // namespace
}  // namespace liloc
