#include "common/registration/spot/ranking.hpp"

#include <gtest/gtest.h>

#include "common/registration/target/surface_bits.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

class RankingLaw : public testing::TestWithParam<unsigned> {};

TEST_P(RankingLaw, NoPoseFarFromTheTruthStandsHigher) {
  const WatchedRoom w = watched_room(GetParam());
  for (const auto& [ranking, tolerance_m] : {std::pair{kSketchRanking, 0.085}, {kRefinedRanking, 0.05}}) {
    const auto standing = [&](const Pose& T_map_sensor) {
      SurfaceBits bits;
      bits.add(w.target, w.query.medium, T_map_sensor);
      return standing_of(judge(w.target, w.query, w.query.medium, T_map_sensor, tolerance_m), bits.sum(),
                         ranking);
    };
    const double truth = standing(w.T_map_device);
    for (int yaw = 1; yaw < 8; ++yaw)
      for (const double shift_m : {0.0, 0.8}) {
        const Pose wrong = scene::looking(w.T_map_device.translation() + Eigen::Vector3d(shift_m, -shift_m, 0),
                                          0.9 * GetParam() + yaw * M_PI / 4, radians(12));
        EXPECT_LT(standing(wrong), truth) << yaw << " " << shift_m;
      }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RankingLaw, testing::Range(1U, 9U));

TEST(Ranking, MuchFloorDoesNotOutweighWhatIsRareAndUncontradicted) {
  const Judgement truth{.agree = 0.33, .map_agree = 1, .map_seen = 0.27, .score = 0.6};
  // As in a crowded hall: three times the agreement, one point in a hundred contradicted.
  const Judgement floor{.agree = 0.87,
                        .conflict = 0.012,
                        .map_agree = 0.99,
                        .map_conflict = 0.008,
                        .map_seen = 0.85,
                        .score = 1.1};
  EXPECT_GT(floor.score, truth.score);
  EXPECT_GT(standing_of(truth, 24, kRefinedRanking), standing_of(floor, 38, kRefinedRanking));
}

TEST(Ranking, EachTermCountsItsWay) {
  for (const Ranking& ranking : {kSketchRanking, kRefinedRanking}) {
    const Judgement j{.agree = 0.5, .conflict = 0.01, .map_agree = 0.9, .map_conflict = 0.02, .map_seen = 0.5};
    Judgement more = j, against = j, blind = j;
    more.agree = 0.6;
    against.conflict = 0.02;
    blind.map_conflict = 0.04;
    const double standing = standing_of(j, 20, ranking);
    EXPECT_GT(standing_of(more, 20, ranking), standing);
    EXPECT_GT(standing_of(j, 21, ranking), standing);
    EXPECT_LT(standing_of(against, 20, ranking), standing);
    EXPECT_LT(standing_of(blind, 20, ranking), standing);
  }
}

}  // namespace
}  // namespace liloc
