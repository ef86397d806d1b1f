#include "common/registration/spot/hypothesis.hpp"

#include <gtest/gtest.h>

#include "common/testing/small_motion.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

class HypothesisLaw : public testing::TestWithParam<unsigned> {};

TEST_P(HypothesisLaw, IsRefinedAndJudgedWhereItEnds) {
  const WatchedRoom w = watched_room(GetParam());
  const SpotProblem problem = w.problem();
  const Hypothesis h = refine_and_judge(problem, w.T_map_device * small_motion(GetParam(), radians(3), 0.1));
  EXPECT_LT(distance_m(h.T_map_sensor(), w.T_map_device), 0.03);
  const Judgement j =
      judge(w.target, w.query, w.query.medium, h.T_map_sensor(), problem.judging.fine_tolerance_m);
  EXPECT_EQ(h.judgement.score, j.score);
  EXPECT_GT(h.judgement.overlap(), 0.9);
}

TEST_P(HypothesisLaw, ANarrowPriorHoldsIt) {
  const WatchedRoom w = watched_room(GetParam());
  PosePrior prior;
  prior.T_target_source = w.T_map_device * small_motion(GetParam(), radians(1), 0.05);
  prior.sd_m = 1e-4;
  prior.sd_rad = 1e-4;
  const Hypothesis held = refine_and_judge(w.problem(), prior.T_target_source, &prior);
  EXPECT_LT(distance_m(held.T_map_sensor(), prior.T_target_source), 0.005);
}

INSTANTIATE_TEST_SUITE_P(Seeds, HypothesisLaw, testing::Range(1U, 6U));

TEST(JudgeOptions, FollowTheVoxelSizeFromTheDefaults) {
  const JudgeOptions usual, same = judge_options_for(0.05), fine = judge_options_for(0.03);
  EXPECT_EQ(same.fine_tolerance_m, usual.fine_tolerance_m);
  EXPECT_EQ(same.sketch_tolerance_m, usual.sketch_tolerance_m);
  EXPECT_EQ(same.refine.end_distance_m, usual.refine.end_distance_m);
  EXPECT_EQ(same.refine.fit_distance_m, usual.refine.fit_distance_m);
  EXPECT_DOUBLE_EQ(fine.fine_tolerance_m, 0.03);
  EXPECT_DOUBLE_EQ(fine.refine.fit_distance_m, 0.03);
  EXPECT_GE(judge_options_for(0.08).sketch_tolerance_m, judge_options_for(0.08).fine_tolerance_m);
}

}  // namespace
}  // namespace liloc
