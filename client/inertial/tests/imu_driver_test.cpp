#include "client/inertial/imu_driver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace liloc {
namespace {

using ::testing::HasSubstr;

/// Of so many samples at rest; how often it told of another unit.
int learn(ForceUnit& unit, double force, int samples) {
  int told = 0;
  for (int i = 0; i < samples; ++i) told += unit.learn({0, 0, force}) ? 1 : 0;
  return told;
}

TEST(ForceUnit, MetresPerSecondSquaredStayAsTheyAre) {
  for (const double force : {9.81, 3.0, 19.6, 60.0}) {
    ForceUnit unit;
    EXPECT_EQ(learn(unit, force, 100), 0) << force;
    EXPECT_EQ(unit.factor(), 1);
    EXPECT_EQ(unit.problem(), "");
  }
}

TEST(ForceUnit, GAndTwiceConvertedAreFoundOnceAndTold) {
  ForceUnit in_g, twice;
  EXPECT_EQ(learn(in_g, 1.0, 19), 0);
  EXPECT_EQ(learn(in_g, 1.0, 100), 1);
  EXPECT_NEAR(in_g.factor(), 9.80665, 1e-12);
  EXPECT_THAT(in_g.problem(), HasSubstr("sends g"));
  EXPECT_EQ(learn(twice, 96.17, 100), 1);
  EXPECT_NEAR(96.17 * twice.factor(), 9.807, 1e-3);
  EXPECT_THAT(twice.problem(), HasSubstr("9.81 times too large"));
}

TEST(ForceUnit, ZerosTellNothing) {
  ForceUnit unit;
  EXPECT_EQ(learn(unit, 0, 100), 0);
  EXPECT_EQ(learn(unit, 1.0, 20), 1);
}

constexpr StampNs kStart = 1'700'000'000'000'000'000;
const Eigen::Vector3d kGravity(0, 0, 9.81), kTurn(0.1, 0, 0), kZero(0, 0, 0);

StampNs at(double ms) {
  return kStart + from_ms(ms);
}

struct Stream {
  SplitMessages::Merged add(double ms, const Eigen::Vector3d& rate, const Eigen::Vector3d& force) {
    sample = {at(ms), rate, force};
    return split.merge(sample, 0, 1);
  }
  SplitMessages split;
  ImuSample sample;  ///< the newest
};

TEST(SplitMessages, WholeSamplesPassAsTheyAre) {
  Stream stream;
  for (int i = 0; i < 200; ++i) {
    EXPECT_TRUE(stream.add(5.0 * i, kTurn, kGravity).whole);
    EXPECT_EQ(stream.sample.specific_force_m_s2, kGravity);
  }
  EXPECT_FALSE(stream.split.now());
  EXPECT_FALSE(stream.split.persist(at(995)));
  EXPECT_FALSE(stream.split.stale(at(995)));
}

TEST(SplitMessages, AGyrosSampleGetsTheNewestForce) {
  Stream stream;
  for (int i = 0; i < 200; ++i) {
    EXPECT_TRUE(stream.add(5.0 * i, kTurn, kZero).whole);
    EXPECT_EQ(stream.sample.specific_force_m_s2.z(), i == 0 ? 0 : 9.0 + i - 1);
    EXPECT_FALSE(stream.add(5.0 * i + 1, kZero, {0, 0, 9.0 + i}).whole) << "an accelerometer's";
  }
  EXPECT_TRUE(stream.split.now());
  EXPECT_TRUE(stream.split.persist(at(1000)));
  EXPECT_FALSE(stream.split.persist(at(2000))) << "long ago";
  EXPECT_EQ(stream.split.force_ns(), at(996));
}

TEST(SplitMessages, AForceThatIsNotToldAnyMoreIsStale) {
  Stream stream;
  EXPECT_TRUE(stream.add(0, kTurn, kZero).whole);
  EXPECT_TRUE(stream.split.stale(at(0))) << "none was told";
  EXPECT_FALSE(stream.add(1, kZero, kGravity).whole);
  EXPECT_TRUE(stream.add(140, kTurn, kZero).whole);
  EXPECT_FALSE(stream.split.stale(at(140)));
  EXPECT_TRUE(stream.add(160, kTurn, kZero).whole);
  EXPECT_TRUE(stream.split.stale(at(160)));
  stream.split.take_off(from_ms(50));
  EXPECT_TRUE(stream.split.stale(at(110)));
  EXPECT_FALSE(stream.split.stale(at(90)));
  stream.split.clock_set();
  EXPECT_TRUE(stream.split.stale(at(90)));
}

TEST(SplitMessages, AForceOfNoSensorIsNotKeptAndTheRangesEndIsTold) {
  Stream stream;
  EXPECT_TRUE(stream.add(0, kTurn, kZero).whole);
  EXPECT_FALSE(stream.add(1, kZero, {0, 0, 19.6}).force_clips);
  EXPECT_TRUE(stream.add(2, kZero, {0, 0, 19.6}).force_clips);
  EXPECT_FALSE(stream.add(3, kZero, {0, 0, 1e6}).force_clips);
  EXPECT_TRUE(stream.add(4, kTurn, kZero).whole);
  EXPECT_EQ(stream.sample.specific_force_m_s2.z(), 19.6);
}

}  // namespace
}  // namespace liloc
