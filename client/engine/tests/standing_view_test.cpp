// A device that stands is told from one that moves, however slowly, whoever walks by.
#include "client/odometry/standing_view.hpp"

#include <gtest/gtest.h>

#include "client/engine/tests/walker.hpp"

namespace liloc {
namespace {

using namespace test;

constexpr double kNoiseM = 0.006;

DepthImage view(const scene::BoxRoom& room, const Pose& T, int frame) {
  return scene::render(room, T, scene::small_camera(), stamp_of(frame), kNoiseM);
}

Pose standpoint() {
  return scene::looking({3, 2.5, 1.2}, 0.6, 0.2);
}

/// Somebody who walks across the view, 1.5 m before the device, at 0.6 m/s.
scene::BoxRoom with_walker(scene::BoxRoom room, double t) {
  const Eigen::Vector3d ahead(std::cos(0.6), std::sin(0.6), 0), left(-std::sin(0.6), std::cos(0.6), 0);
  const Eigen::Vector3d at = Eigen::Vector3d(3, 2.5, 0) + 1.5 * ahead + (0.6 * t - 1.5) * left;
  room.furniture.push_back({at + Eigen::Vector3d(-0.25, -0.25, 0), at + Eigen::Vector3d(0.25, 0.25, 1.75)});
  return room;
}

/// Learned from frames that stand, with the reference set.
StandingView looking_at(const scene::BoxRoom& room) {
  StandingView standing(scene::small_camera());
  for (int i = 0; i < 10; ++i) standing.next(view(room, standpoint(), i));
  standing.refer(standpoint());
  return standing;
}

class StandingLaw : public testing::TestWithParam<unsigned> {};

TEST_P(StandingLaw, StandsWhileNothingMoves) {
  const auto room = scene::furnished_room(GetParam());
  StandingView standing = looking_at(room);
  for (int i = 10; i < 40; ++i) {
    const StandingCheck check = standing.compare(view(room, standpoint(), i));
    EXPECT_FALSE(check.moved) << i;
    EXPECT_GT(check.share, 0.95);
  }
}

TEST_P(StandingLaw, TellsASmallMotionOfAnyKind) {
  const auto room = scene::furnished_room(GetParam());
  StandingView standing = looking_at(room);
  for (int axis = 0; axis < 6; ++axis) {
    Vector6d motion = Vector6d::Zero();
    motion[axis] = axis < 3 ? radians(0.8) : 0.03;
    const StandingCheck check = standing.compare(view(room, standpoint() * increment(motion), 10 + axis));
    EXPECT_FALSE(check.stands) << axis << ": " << check.agree_least << " agree, known to " << check.sd_m;
  }
}

TEST_P(StandingLaw, MeasuresWhatItTells) {
  const auto room = scene::furnished_room(GetParam());
  StandingView standing = looking_at(room);
  for (int axis = 0; axis < 6; ++axis) {
    Vector6d motion = Vector6d::Zero();
    motion[axis] = axis < 3 ? radians(0.1) : 0.003;
    const StandingCheck check = standing.compare(view(room, standpoint() * increment(motion), 20 + axis));
    if (check.sd_m > 0.005) continue;  // this room shows too little
    const Vector6d off = check.motion - motion;
    EXPECT_LT(off.head<3>().norm(), radians(0.15)) << axis;
    EXPECT_LT(off.tail<3>().norm(), 0.006) << axis;
  }
}
INSTANTIATE_TEST_SUITE_P(Rooms, StandingLaw, testing::Range(1U, 9U));

TEST(StandingView, ABareWallProvesNothing) {
  const Pose T = scene::looking({0, 1, 1.2}, 1.5707963, 0.4);
  StandingView standing(scene::small_camera());
  for (int i = 0; i < 10; ++i) standing.next(view(scene::corridor(), T, i));
  standing.refer(T);
  for (int i = 10; i < 20; ++i) {
    Pose T_along = T;
    T_along.translation().x() += 0.02 * (i - 10);
    const StandingCheck check = standing.compare(view(scene::corridor(), T_along, i));
    EXPECT_GT(check.share, 0.9);
    EXPECT_FALSE(check.stands) << i;
  }
}

struct Motion {
  const char* name;
  double speed_m_s, turn_deg_s;
  bool imu, walker;
};

void PrintTo(const Motion& motion, std::ostream* out) {
  *out << motion.name;
}

/// An engine over ten seconds of a slow motion, or none.
class SlowMotion : public testing::TestWithParam<Motion> {};

TEST_P(SlowMotion, IsFollowed) {
  const Motion& m = GetParam();
  const auto pose_at = [&](double t) {
    const double moving = std::max(0.0, t - kStillS);
    return scene::looking(Eigen::Vector3d(3, 2.5, 1.2) + m.speed_m_s * moving * Eigen::Vector3d(0.6, 0.7, 0.2),
                          0.6 + radians(m.turn_deg_s) * moving, 0.2);
  };
  for (const unsigned seed : {1U, 3U}) {
    EngineOptions options = engine_options();
    std::vector<ImuSample> imu;
    if (m.imu) {
      options.T_imu_sensor = mounting();
      options.still_seconds = kStillS;
      imu = scene::imu_along(pose_at, mounting(), 0, 10.5, 200, kStart);
    }
    Engine engine(options);
    const auto room = scene::furnished_room(seed);
    std::size_t next = 0;
    Pose first = Pose::Identity();
    int standing = 0;
    for (int i = 0; i < 150; ++i) {
      for (; next < imu.size() && imu[next].stamp_ns <= stamp_of(i); ++next)
        ASSERT_TRUE(engine.add_imu(imu[next]));
      const auto frame =
          engine.add_depth(view(m.walker ? with_walker(room, time_of(i) - 2) : room, pose_at(time_of(i)), i));
      ASSERT_TRUE(frame);
      if (i == 0) first = frame->T_odom_sensor;
      standing += frame->source == PoseSource::standing;
      const Pose error = (pose_at(time_of(0)).inverse() * pose_at(time_of(i))).inverse() *
                         (first.inverse() * frame->T_odom_sensor);
      if (!frame->converged) continue;  // marked
      EXPECT_LT(error.translation().norm(), 0.01) << "seed " << seed << ", frame " << i;
      EXPECT_LT(degrees(rotation_angle_rad(error)), 0.3) << "seed " << seed << ", frame " << i;
    }
    if (m.speed_m_s == 0 && m.turn_deg_s == 0) {
      EXPECT_GT(standing, 100) << "seed " << seed;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(
    Motions, SlowMotion,
    testing::Values(Motion{"stands", 0, 0, false, false}, Motion{"stands_beside_a_walker", 0, 0, false, true},
                    Motion{"stands_beside_a_walker_with_imu", 0, 0, true, true},
                    Motion{"creeps", 0.005, 0, false, false}, Motion{"creeps_with_imu", 0.005, 0, true, false},
                    Motion{"creeps_beside_a_walker", 0.005, 0, false, true},
                    Motion{"turns", 0, 0.5, false, false}, Motion{"turns_with_imu", 0, 0.5, true, false},
                    Motion{"walks_slowly", 0.05, 1, true, false}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace liloc
