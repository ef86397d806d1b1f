#include "common/registration/spot/align_evidence.hpp"

#include <gtest/gtest.h>

#include "common/testing/small_motion.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

class AlignWitnessLaw : public testing::TestWithParam<unsigned> {};

Alignment at(const Pose& T_target_source) {
  Alignment alignment;
  alignment.T_target_source = T_target_source;
  alignment.pairs = 17;
  return alignment;
}

/// The device's own cloud moved, so that both are seen from their origins.
TEST_P(AlignWitnessLaw, SpeaksForTheTruthAndAgainstAnotherPlace) {
  const WatchedRoom w = watched_room(GetParam());
  const Pose T_target_source = small_motion(GetParam(), 0.3, 0.4);
  const Cloud& target_cloud = w.query.cloud;
  const Target target = make_target(target_cloud, {}, 0.05);
  const Query source = make_query(transformed(T_target_source.inverse(), target_cloud), nullptr, {});
  std::vector<FeatureMatch> matches;
  const Cloud& some = source.medium;
  for (std::size_t i = 0; i < some.size(); i += 5)
    matches.push_back({some.points[i], T_target_source.cast<float>() * some.points[i], some.normals[i],
                       T_target_source.linear().cast<float>() * some.normals[i]});
  const SpotProblem problem{target, source};
  const AlignWitness witness(problem, matches, 0.05);
  const Pose wrong = T_target_source * small_motion(GetParam() + 50, 1.2, 1.5);
  const AlignEvidence truth = witness.of(at(T_target_source)), other = witness.of(at(wrong));
  EXPECT_EQ(truth.pairs, 17) << "those of the alignment";
  EXPECT_EQ(truth.matched, static_cast<int>(matches.size()));
  EXPECT_LT(other.matched, truth.matched / 4);
  EXPECT_GT(truth.fitness, 0.95);
  EXPECT_LT(other.fitness, truth.fitness);
  EXPECT_LE(truth.conflict, other.conflict);
  EXPECT_GT(log_odds_of(truth), log_odds_of(other));
  EXPECT_GT(witness.sketch_score(T_target_source), witness.sketch_score(wrong));
  EXPECT_TRUE(witness.possible(T_target_source));
}

INSTANTIATE_TEST_SUITE_P(Seeds, AlignWitnessLaw, testing::Range(1U, 7U));

TEST(AlignConfidence, OfTwoThatAreAlikeNeitherIsLikelierThanNot) {
  for (const double odds : {-5.0, 0.0, 3.0, 30.0}) {
    EXPECT_LE(confidence_of({odds, odds}), 0.5);
    EXPECT_LE(confidence_of({odds, odds - 1}), confidence_of({odds, odds - 2}));
    EXPECT_LT(confidence_of({odds}), confidence_of({odds + 1}));
  }
}

TEST(AlignConfidence, EmptySpaceSpeaksAgainstAndFeaturesSpeakFor) {
  AlignEvidence evidence;
  evidence.agree = 500;
  evidence.matched = 40;
  AlignEvidence more = evidence, contradicted = evidence;
  more.matched = 80;
  contradicted.conflict = 20;
  EXPECT_GT(log_odds_of(more), log_odds_of(evidence));
  EXPECT_LT(log_odds_of(contradicted), log_odds_of(evidence));
}

}  // namespace
}  // namespace liloc
