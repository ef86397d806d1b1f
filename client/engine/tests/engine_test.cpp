#include "client/engine/engine.hpp"

#include <gtest/gtest.h>

#include "client/engine/tests/walker.hpp"
#include "common/codec/codec.hpp"

namespace liloc {
namespace {

using namespace test;

/// Feeds a walk to an engine, with an IMU or without.
class Walker {
 public:
  explicit Walker(EngineOptions options, unsigned seed = 1)
      : room_(scene::furnished_room(seed)), engine(options) {
    if (options.T_imu_sensor) imu_ = scene::imu_along(walk, mounting(), 0, 12, 200, kStart);
  }
  FrameResult step(bool covered = false) {
    for (; next_imu_ < imu_.size() && imu_[next_imu_].stamp_ns <= stamp_of(frame); ++next_imu_)
      EXPECT_TRUE(engine.add_imu(imu_[next_imu_]));
    auto result = engine.add_depth(covered ? covered_at(frame) : frame_at(room_, frame));
    EXPECT_TRUE(result) << (result ? "" : result.error().message);
    ++frame;
    return *result;
  }
  /// Error of the odometry from the first frame to the one that was just fed.
  [[nodiscard]] Pose error(const Pose& T_odom_first, const Pose& T_odom_now) const {
    return (walk(time_of(0)).inverse() * walk(time_of(frame - 1))).inverse() *
           (T_odom_first.inverse() * T_odom_now);
  }

 private:
  scene::BoxRoom room_;
  std::vector<ImuSample> imu_;
  std::size_t next_imu_ = 0;

 public:
  Engine engine;
  int frame = 0;
};

EngineOptions with_imu(LocalMethod local = LocalMethod::cloud) {
  EngineOptions options = engine_options();
  options.local = local;
  options.T_imu_sensor = mounting();
  options.still_seconds = kStillS;
  return options;
}

struct Case {
  const char* name;
  EngineOptions options;
  double drift_m;
  std::vector<unsigned> seeds{1, 2, 3, 4, 5, 6, 7, 8};
};

void PrintTo(const Case& tested, std::ostream* out) {
  *out << tested.name;
}

/// The walk in rooms 2, 4, 7 and 8 passes a bare wall, along which only an IMU shows the motion.
class Drift : public testing::TestWithParam<Case> {};

TEST_P(Drift, StaysBounded) {
  for (const unsigned seed : GetParam().seeds) {
    Walker walker(GetParam().options, seed);
    const Pose first = walker.step().T_odom_sensor;
    Pose now = first;
    for (int i = 1; i < 120; ++i) {
      const FrameResult frame = walker.step();
      EXPECT_TRUE(frame.informative) << i;
      EXPECT_EQ(frame.odom_segment, 0U);
      now = frame.T_odom_sensor;
    }
    EXPECT_LT(walker.error(first, now).translation().norm(), GetParam().drift_m)
        << "seed " << seed;  // path: 5 m
    EXPECT_LT(degrees(rotation_angle_rad(walker.error(first, now))), 1.0) << "seed " << seed;
  }
}
INSTANTIATE_TEST_SUITE_P(Methods, Drift,
                         testing::Values(Case{"cloud", engine_options(), 0.03, {1, 3, 5, 6}},
                                         Case{"imu", with_imu(), 0.03},
                                         Case{"inertial", with_imu(LocalMethod::inertial), 0.03},
                                         Case{"reckoning", with_imu(LocalMethod::dead_reckoning), 0.6}),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(Engine, NamesHowEachPoseWasFound) {
  Walker cloud(engine_options()), inertial(with_imu(LocalMethod::inertial));
  EXPECT_EQ(cloud.step().source, PoseSource::first);
  EXPECT_EQ(cloud.step().source, PoseSource::standing);
  while (cloud.frame < 20) cloud.step();
  EXPECT_EQ(cloud.step().source, PoseSource::icp);
  EXPECT_EQ(inertial.step().source, PoseSource::first);
  EXPECT_EQ(inertial.step().source, PoseSource::inertial);
  EXPECT_EQ(cloud.step(true).source, PoseSource::guess);
}

TEST(Engine, TellsWhichAxesTheFrameShowed) {
  Walker furnished(engine_options());
  furnished.step();
  EXPECT_GT(furnished.step().observed.minCoeff(), 0.99);
  EXPECT_EQ(furnished.step(true).observed.maxCoeff(), 0);  // a guess

  Engine engine(engine_options());
  FrameResult frame;
  for (int i = 0; i < 5; ++i)
    frame =
        *engine.add_depth(scene::render(scene::corridor(), scene::looking({0.02 * i, 1, 1.2}, 1.5707963, 0.4),
                                        scene::small_camera(), stamp_of(i), 0.003));
  EXPECT_LT(frame.observed[3], 0.1);  // sensor x: along the wall
  EXPECT_GT(frame.observed[5], 0.9);  // sensor z: towards it
}

TEST(Engine, AnswersBringRequestsForwardUntilOneIsVerified) {
  Walker walker(engine_options());
  SpotReply reply;
  std::vector<int> asked;
  for (int i = 0; i < 45; ++i) {  // 3 s
    walker.step();
    const auto request = walker.engine.take_request();
    if (!request) continue;
    asked.push_back(i);
    reply.seq = request->seq;
    reply.stamp_ns = request->stamp_ns;
    const bool third = asked.size() == 3;
    reply.status = third ? SpotStatus::verified : SpotStatus::provisional;
    if (third) reply.T_map_odom = Pose::Identity();
    walker.engine.add_reply(reply);
  }
  EXPECT_EQ(asked, (std::vector<int>{0, 3, 6, 18, 30, 42}));  // 0.2 s apart, then 0.8 s
}

TEST(Engine, ABlockedCameraIsBridgedAndAskedAboutAfterwards) {
  Walker walker(with_imu());
  const Pose first = walker.step().T_odom_sensor;
  for (int i = 1; i < 40; ++i) walker.step();
  static_cast<void>(walker.engine.take_request());
  for (int i = 0; i < 12; ++i) {
    const FrameResult frame = walker.step(true);
    EXPECT_FALSE(frame.informative);
    EXPECT_FALSE(frame.converged);
    EXPECT_FALSE(walker.engine.take_request());
  }
  const FrameResult after = walker.step();
  EXPECT_TRUE(after.informative && after.converged);
  EXPECT_EQ(after.odom_segment, 0U);
  EXPECT_LT(walker.error(first, after.T_odom_sensor).translation().norm(), 0.05);
  EXPECT_TRUE(walker.engine.take_request());
}

TEST(Engine, TheDiscontinuityAfterAGuessIsMarked) {
  Walker walker(engine_options());  // without an IMU the guess stays behind
  Pose last = walker.step().T_odom_sensor;
  int discontinuities = 0;
  for (int i = 1; i < 60; ++i) {
    const FrameResult now = walker.step(i > 30 && i <= 36);
    const Pose T_true = walk(time_of(i - 1)).inverse() * walk(time_of(i));
    const double step_error_m = distance_m(last * T_true, now.T_odom_sensor);
    EXPECT_TRUE(!now.converged || step_error_m < 0.03) << "frame " << i << ": " << step_error_m;
    discontinuities += !now.converged && now.source == PoseSource::icp ? 1 : 0;
    last = now.T_odom_sensor;
  }
  EXPECT_EQ(discontinuities, 1);
}

TEST(Engine, AfterABlackoutItIsNotFoundWhereNobodyCarriesItInThatTime) {
  const auto room = scene::furnished_room(2);
  Engine engine(engine_options());
  const auto see = [&](double x, int frame) {
    return *engine.add_depth(scene::render(room, scene::looking({x, 2.5, 1.2}, 0.5 * (x - 1.2), 0.2),
                                           scene::small_camera(), stamp_of(frame), 0.004));
  };
  int frame = 0;
  for (; frame < 60; ++frame) see(1.2 + 3.0 * frame / 60, frame);  // 0.75 m/s
  const Pose last = see(4.2, frame++).T_odom_sensor;
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(engine.add_depth(covered_at(frame++)));
  for (int i = 0; i < 5; ++i) {  // the view of the start, 3 m away, a third of a second later
    const FrameResult now = see(1.2, frame++);
    EXPECT_LT(distance_m(last, now.T_odom_sensor), 1.5) << name_of(now.source);
  }
}

TEST(Engine, ALongBlackoutStartsANewSegmentWhereTheOldOneEnded) {
  Walker walker(engine_options());
  FrameResult frame;
  for (int i = 0; i < 20; ++i) frame = walker.step();
  for (int i = 0; i < 80; ++i) frame = walker.step(true);  // 5.3 s
  const Pose before = frame.T_odom_sensor;
  EXPECT_EQ(frame.odom_segment, 0U);
  frame = walker.step();
  EXPECT_EQ(frame.odom_segment, 1U);
  EXPECT_LT(distance_m(before, frame.T_odom_sensor), 0.05);  // bridged, continuous
  const auto request = walker.engine.take_request();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->odom_segment, 1U);
  EXPECT_EQ(request->local_poses.size(), 1U);  // those of the old segment say nothing about it
  frame = walker.step();
  EXPECT_EQ(frame.source, PoseSource::icp);
  EXPECT_EQ(frame.odom_segment, 1U);
}

TEST(Engine, ARequestCarriesWhatTheServerNeeds) {
  Walker walker(with_imu());
  walker.step();
  ASSERT_TRUE(walker.engine.take_request());
  EXPECT_FALSE(walker.engine.take_request());  // taken once
  std::optional<SpotRequest> request;
  FrameResult frame;
  while (!request) {
    frame = walker.step();
    request = walker.engine.take_request();
  }
  EXPECT_EQ(request->client_id, "walker");
  EXPECT_EQ(request->seq, 2U);
  EXPECT_EQ(request->stamp_ns, stamp_of(12));  // 800 ms after the first at 15 Hz
  EXPECT_LT(distance_m(request->T_odom_sensor, frame.T_odom_sensor), 1e-9);
  ASSERT_EQ(request->local_poses.size(), 12U);
  EXPECT_EQ(request->local_poses.back().stamp_ns, request->stamp_ns);
  EXPECT_GT(request->odom_sd_m, 0.0);
  ASSERT_TRUE(request->up_sensor);
  const Eigen::Vector3d up = walk(time_of(12)).linear().transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_LT(degrees(std::acos(std::min(1.0, up.dot(*request->up_sensor)))), 1.0);
  const auto cloud = decode(request->lpc);
  ASSERT_TRUE(cloud) << cloud.error().message;
  EXPECT_GT(cloud->size(), 500U);
  EXPECT_EQ(request->view.camera.width, 160);
  EXPECT_FALSE(request->cold);
}

TEST(Engine, WithoutAnImuUpIsUnknown) {
  Walker walker(engine_options());
  walker.step();
  EXPECT_FALSE(walker.engine.take_request()->up_sensor);
  EXPECT_FALSE(walker.engine.add_imu({kStart, {0, 0, 0}, {0, 0, 9.81}}));
}

TEST(Engine, ARepliesMoveMapToOdomAndNeverOdom) {
  Walker told(with_imu()), untold(with_imu());
  for (int i = 0; i < 60; ++i) {
    const FrameResult a = told.step(), b = untold.step();
    EXPECT_LT(distance_m(a.T_odom_sensor, b.T_odom_sensor), 1e-12);
    EXPECT_EQ(a.T_map_sensor.has_value(), i > 20);
    EXPECT_FALSE(b.T_map_sensor);
    if (a.T_map_sensor) {
      EXPECT_LT(distance_m(*a.T_map_sensor, *told.engine.T_map_odom() * a.T_odom_sensor), 1e-12);
    }
    if (i != 20 && i != 40) continue;
    SpotReply reply;
    reply.seq = 1;
    reply.stamp_ns = a.stamp_ns;
    reply.status = SpotStatus::verified;
    reply.T_map_odom = Pose(Eigen::Translation3d(i, 2, 3));
    told.engine.add_reply(reply);
    EXPECT_EQ(told.engine.tracking(), Tracking::tracking);
    EXPECT_DOUBLE_EQ(told.engine.T_map_odom()->translation().x(), i);
  }
  EXPECT_EQ(untold.engine.tracking(), Tracking::searching);
}

TEST(Engine, SilenceIsNamedAndBecomesCoasting) {
  EngineOptions options = engine_options();
  options.reply_timeout_ns = from_ms(1000);
  Walker walker(options);
  walker.step();
  SpotReply reply;
  reply.seq = walker.engine.take_request()->seq;
  reply.stamp_ns = stamp_of(0);
  reply.status = SpotStatus::verified;
  reply.T_map_odom = Pose::Identity();
  walker.engine.add_reply(reply);
  std::vector<std::uint64_t> unanswered;
  for (int i = 1; i < 45; ++i) {
    walker.step();
    for (const auto seq : walker.engine.take_unanswered()) unanswered.push_back(seq);
  }
  EXPECT_EQ(walker.engine.tracking(), Tracking::coasting);  // 3 s > 3 intervals
  ASSERT_FALSE(unanswered.empty());
  EXPECT_EQ(unanswered.front(), 2U);
}

TEST(Engine, RefusesAWrongSizeAndAnOldStamp) {
  Walker walker(engine_options());
  walker.step();
  DepthImage wrong = covered_at(5);
  wrong.width = 100;
  EXPECT_FALSE(walker.engine.add_depth(wrong));
  EXPECT_FALSE(walker.engine.add_depth(covered_at(0)));
  DepthImage torn = covered_at(6);
  torn.units.pop_back();
  EXPECT_FALSE(walker.engine.add_depth(torn));
  EXPECT_EQ(walker.step().source, PoseSource::standing);  // none of it did harm
}

TEST(Engine, TwoRunsAreEqual) {
  Walker a(with_imu()), b(with_imu());
  for (int i = 0; i < 40; ++i) {
    const Pose x = a.step(i > 25 && i < 30).T_odom_sensor, y = b.step(i > 25 && i < 30).T_odom_sensor;
    ASSERT_TRUE(x.matrix() == y.matrix()) << i;
  }
}

}  // namespace
}  // namespace liloc
