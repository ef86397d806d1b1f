#include "common/registration/spot/spot.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/testing/small_motion.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

class SpotLaw : public testing::TestWithParam<unsigned> {};

/// Wrong places about the room, each proposed with a higher score than the right one, which comes last.
std::vector<Candidate> proposed(const WatchedRoom& w, unsigned seed) {
  std::vector<Candidate> candidates;
  for (int yaw = 1; yaw < 8; ++yaw)
    for (const double shift_m : {0.0, 0.8})
      candidates.push_back({scene::looking(w.T_map_device.translation() + Eigen::Vector3d(shift_m, -shift_m, 0),
                                           0.9 * seed + yaw * M_PI / 4, radians(12)),
                            10.0 + yaw});
  candidates.push_back({w.T_map_device * small_motion(seed, radians(3), 0.08), 1.0});
  return candidates;
}

TEST_P(SpotLaw, TheRightPlaceComesFirstWhateverWasProposedHigher) {
  const WatchedRoom w = watched_room(GetParam());
  const SpotProblem problem = w.problem();
  const auto found = judge_candidates(problem, proposed(w, GetParam()));
  ASSERT_FALSE(found.empty());
  EXPECT_LT(distance_m(found.front().T_map_sensor(), w.T_map_device), 0.04);
  EXPECT_LT(degrees(angle_between_rad(found.front().T_map_sensor(), w.T_map_device)), 1);
  EXPECT_LE(found.size(), problem.judging.keep);
  for (std::size_t i = 1; i < found.size(); ++i) {
    EXPECT_GE(found[0].standing, found[i].standing);
    if (i > 1) {
      EXPECT_GE(found[i - 1].judgement.score, found[i].judgement.score);
    }
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_FALSE(same_place(found[i].T_map_sensor(), found[k].T_map_sensor()));
  }
}

TEST_P(SpotLaw, ProposedTwiceItIsFoundOnce) {
  const WatchedRoom w = watched_room(GetParam());
  std::vector<Candidate> candidates;
  for (unsigned i = 0; i < 6; ++i)  // apart enough to be places of their own, which refine to one
    candidates.push_back({w.T_map_device * small_motion(10 * GetParam() + i, radians(9), 0.05), 1.0});
  ASSERT_GT(distinct(candidates, candidates.size()).size(), 1U);
  EXPECT_EQ(judge_candidates(w.problem(), candidates).size(), 1U);
}

INSTANTIATE_TEST_SUITE_P(Seeds, SpotLaw, testing::Range(1U, 6U));

TEST(Spot, NothingProposedIsNothingFound) {
  const WatchedRoom w = watched_room(1);
  EXPECT_TRUE(judge_candidates(w.problem(), {}).empty());
}

}  // namespace
}  // namespace liloc
