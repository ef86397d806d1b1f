#include "common/registration/spot/judge.hpp"

#include <gtest/gtest.h>

#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

class JudgeLaw : public testing::TestWithParam<unsigned> {};

TEST_P(JudgeLaw, TheTruthConflictsWithNothing) {
  const WatchedRoom w = watched_room(GetParam());
  const Judgement j = judge(w.target, w.query, w.query.medium, w.T_map_device, 0.05);
  EXPECT_LT(j.conflict, 0.02);
  EXPECT_LT(j.map_conflict, 0.03);
  EXPECT_GT(j.overlap(), 0.95);
}

TEST_P(JudgeLaw, NoPoseFarFromTheTruthScoresHigher) {
  const WatchedRoom w = watched_room(GetParam());
  const double truth = judge(w.target, w.query, w.query.medium, w.T_map_device, 0.05).score;
  for (int yaw = 1; yaw < 8; ++yaw)
    for (const double shift : {0.0, 0.8}) {
      Pose wrong = scene::looking(w.T_map_device.translation() + Eigen::Vector3d(shift, -shift, 0),
                                  0.9 * GetParam() + yaw * M_PI / 4, radians(12));
      EXPECT_LT(judge(w.target, w.query, w.query.medium, wrong, 0.05).score, truth) << yaw << " " << shift;
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, JudgeLaw, testing::Range(1U, 9U));

}  // namespace
}  // namespace liloc
