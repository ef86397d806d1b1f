// An engine follows a slow motion, whoever walks by.
#include <gtest/gtest.h>

#include "client/engine/tests/walker.hpp"
#include "client/odometry/tests/walked_by.hpp"

namespace liloc {
namespace {

using namespace test;

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
