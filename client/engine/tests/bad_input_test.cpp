// What drivers get wrong: the engine goes on, and says what it noticed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/engine/tests/walker.hpp"

namespace liloc {
namespace {

using namespace test;
using ::testing::HasSubstr;

/// The walk in room 1, with each input open to spoiling.
struct Feed {
  explicit Feed(double imu_hz = 200, double frame_hz = kFrameHz) : hz(frame_hz), imu_hz_(imu_hz) {
    options = engine_options();
    options.T_imu_sensor = mounting();
    options.still_seconds = kStillS;
  }
  /// Error of the odometry at the end, metres.
  double run(double seconds) {
    Engine made(options);
    const auto room = scene::furnished_room(room_seed);
    const auto imu = scene::imu_along(walk, mounting(), 0, seconds + 0.1, imu_hz_, kStart);
    std::size_t next = 0;
    std::optional<Pose> first;
    for (double t = 0.05; t < seconds; t += 1 / hz) {
      const StampNs stamp = kStart + from_seconds(t);
      for (; next < imu.size() && imu[next].stamp_ns <= stamp; ++next) {
        ImuSample sample = imu[next];
        if (spoil_imu(sample)) static_cast<void>(made.add_imu(sample));
      }
      DepthImage image = scene::render(room, walk(t), scene::small_camera(), stamp, 0.004);
      spoil_depth(image);
      const auto frame = made.add_depth(image);
      EXPECT_TRUE(frame);
      if (!frame) continue;
      guesses += frame->source == PoseSource::guess;
      if (std::string now = made.problem(); !now.empty()) problem = now;
      segments = static_cast<int>(frame->odom_segment) + 1;
      if (!first) first = frame->T_odom_sensor;
      error_m = distance_m(walk(0.05).inverse() * walk(t), first->inverse() * frame->T_odom_sensor);
    }
    return error_m;
  }

  EngineOptions options;
  double hz;
  std::function<bool(ImuSample&)> spoil_imu = [](ImuSample&) { return true; };
  std::function<void(DepthImage&)> spoil_depth = [](DepthImage&) {};
  unsigned room_seed = 1;
  std::string problem;  ///< the last one said
  int guesses = 0, segments = 0;
  double error_m = 0;

 private:
  double imu_hz_;
};

TEST(BadInput, GoodInputIsNotComplainedOf) {
  Feed feed;
  EXPECT_LT(feed.run(6), 0.03);
  EXPECT_EQ(feed.problem, "");
}

TEST(BadInput, FramesAt60HzAndAt1Hz) {
  Feed fast(200, 60);
  EXPECT_LT(fast.run(4), 0.03);
  EXPECT_EQ(fast.segments, 1);
  Feed slow(200, 1);
  slow.run(8);
  EXPECT_LE(slow.guesses, 2);  // a step of a second is bridged by the IMU
  EXPECT_LT(slow.error_m, 0.1);
}

class ImuRate : public testing::TestWithParam<double> {};
TEST_P(ImuRate, IsTheDriversChoice) {
  Feed feed(GetParam());
  EXPECT_LT(feed.run(6), 0.03);
  EXPECT_EQ(feed.problem, "");
}
INSTANTIATE_TEST_SUITE_P(Hz, ImuRate, testing::Values(100.0, 400.0));

struct ImuFault {
  const char* name;
  bool (*spoil)(ImuSample&, bool fourth_second);  ///< false: the sample is lost
  double error_m;
  const char* says;
};

void PrintTo(const ImuFault& fault, std::ostream* out) {
  *out << fault.name;
}

class FaultyImu : public testing::TestWithParam<ImuFault> {};
TEST_P(FaultyImu, IsNamedAndDoesLittleHarm) {
  Feed feed;
  feed.spoil_imu = [](ImuSample& s) {
    const double t = to_seconds(s.stamp_ns - kStart);
    return GetParam().spoil(s, t >= 3 && t <= 4);
  };
  EXPECT_LT(feed.run(6), GetParam().error_m);
  EXPECT_THAT(feed.problem, HasSubstr(GetParam().says));
  EXPECT_EQ(feed.segments, 1);
}

bool pauses(ImuSample&, bool now) {
  return !now;
}
bool is_in_g(ImuSample& s, bool) {
  s.specific_force_m_s2 /= 9.80665;
  return true;
}
bool is_saturated(ImuSample& s, bool now) {
  if (now) s.angular_velocity_rad_s = {4.36, -4.36, 4.36};  // the end of a 250 deg/s range
  return true;
}
INSTANTIATE_TEST_SUITE_P(Faults, FaultyImu,
                         testing::Values(ImuFault{"pauses", pauses, 0.05, "no IMU samples"},
                                         ImuFault{"in_g", is_in_g, 0.03, "in place of m/s^2"},
                                         ImuFault{"saturated", is_saturated, 0.05, "end of its range"}),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(BadInput, EmptyFramesAreNamedAndHarmless) {
  Feed feed;
  feed.spoil_depth = [](DepthImage& image) {
    const double t = to_seconds(image.stamp_ns - kStart);
    if (t > 3 && t < 4.2) std::fill(image.units.begin(), image.units.end(), 0);
  };
  EXPECT_LT(feed.run(6), 0.10);
  EXPECT_THAT(feed.problem, HasSubstr("hardly a return"));
}

TEST(BadInput, FramesOutOfOrderAndRepeatedAreRefusedAndHarmless) {
  Engine engine(engine_options()), clean(engine_options());
  const auto room = scene::furnished_room(1);
  FrameResult expected, now;
  for (int i = 0; i < 30; ++i) {
    const DepthImage image = frame_at(room, i);
    expected = *clean.add_depth(image);
    now = *engine.add_depth(image);
    EXPECT_FALSE(engine.add_depth(image));
    if (i > 3) {
      EXPECT_FALSE(engine.add_depth(frame_at(room, i - 3)));
    }
  }
  EXPECT_TRUE(now.T_odom_sensor.matrix() == expected.T_odom_sensor.matrix());
}

TEST(BadInput, WrongIntrinsicsAreNoticed) {
  Feed feed;
  feed.options.camera.fx *= 1.25;
  feed.options.camera.fy *= 1.25;
  feed.run(8);
  EXPECT_THAT(feed.problem, HasSubstr("intrinsics"));
}

TEST(BadInput, EightPercentOfFocalLengthAreNoticedAndNothingElse) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    for (const double factor : {0.92, 1.0, 1.08}) {
      Feed feed;
      feed.room_seed = seed;
      feed.options.camera.fx *= factor;
      feed.options.camera.fy *= factor;
      feed.run(8);
      EXPECT_EQ(feed.problem.find("intrinsics") != std::string::npos, factor != 1.0)
          << "room " << seed << ", " << factor << " of the focal length: '" << feed.problem << "'";
    }
  }
}

TEST(BadInput, AWrongMountingOfTheImuIsNoticed) {
  Feed feed;
  feed.options.T_imu_sensor->linear() = so3_exp({0, 0, 0.3}) * feed.options.T_imu_sensor->linear();
  feed.run(8);
  EXPECT_THAT(feed.problem, HasSubstr("T_imu_sensor"));
  EXPECT_LT(feed.error_m, 0.3);  // and does less harm than it could
}

TEST(BadInput, NotANumberFromTheImuIsRefused) {
  EngineOptions options = engine_options();
  options.T_imu_sensor = mounting();
  Engine engine(options);
  EXPECT_FALSE(engine.add_imu({kStart, {NAN, 0, 0}, {0, 0, 9.81}}));
  EXPECT_TRUE(engine.add_imu({kStart, {0, 0, 0}, {0, 0, 9.81}}));
  EXPECT_FALSE(engine.add_imu({kStart, {0, 0, 0}, {0, 0, 9.81}}));  // the same again
}

}  // namespace
}  // namespace liloc
