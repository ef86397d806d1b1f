#include "common/registration/search/candidate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace liloc {
namespace {

class CandidateLaw : public testing::TestWithParam<unsigned> {};

std::vector<Candidate> crowded(unsigned seed) {
  std::mt19937_64 rng(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<Candidate> candidates(200);
  for (Candidate& c : candidates) {
    Vector6d a;
    a << 0.2 * unit(rng), 0, 0, unit(rng), unit(rng), 0;
    c = {increment(a), unit(rng)};
  }
  return candidates;
}

TEST_P(CandidateLaw, EachPlaceKeepsItsBestAndNoTwoShareAPlace) {
  const std::vector<Candidate> all = crowded(GetParam()), kept = distinct(all, all.size());
  ASSERT_GT(kept.size(), 5U);
  ASSERT_LT(kept.size(), all.size());
  EXPECT_TRUE(std::ranges::is_sorted(kept, std::greater{}, &Candidate::score));
  for (std::size_t i = 0; i < kept.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(same_place(kept[i].T_map_sensor, kept[k].T_map_sensor));
  for (const Candidate& c : all)
    EXPECT_TRUE(std::ranges::any_of(kept, [&](const Candidate& k) {
      return k.score >= c.score &&
             (same_place(k.T_map_sensor, c.T_map_sensor) || k.T_map_sensor.isApprox(c.T_map_sensor));
    })) << "what is left out has a better one in its place";
}

TEST_P(CandidateLaw, FewerAreTheFirstOfMore) {
  const std::vector<Candidate> all = crowded(GetParam()), more = distinct(all, all.size()),
                               few = distinct(all, 4);
  ASSERT_EQ(few.size(), 4U);
  for (std::size_t i = 0; i < few.size(); ++i) EXPECT_EQ(few[i].score, more[i].score);
  EXPECT_TRUE(distinct(all, 0).empty());
}

INSTANTIATE_TEST_SUITE_P(Seeds, CandidateLaw, testing::Range(1U, 6U));

TEST(SamePlace, NeedsBothDistanceAndAngle) {
  Pose shifted = Pose::Identity(), turned = Pose::Identity();
  shifted.translation().x() = 0.24;
  turned.linear() = so3_exp({0, 0, radians(7.9)});
  EXPECT_TRUE(same_place(shifted, Pose::Identity()));
  EXPECT_TRUE(same_place(turned, Pose::Identity()));
  EXPECT_FALSE(same_place(shifted, Pose::Identity(), {0.2, radians(8)}));
  EXPECT_FALSE(same_place(turned, Pose::Identity(), {0.25, radians(7)}));
}

}  // namespace
}  // namespace liloc
