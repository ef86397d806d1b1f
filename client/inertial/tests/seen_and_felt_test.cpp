#include "client/inertial/seen_and_felt.hpp"

#include <gtest/gtest.h>

#include <random>

namespace liloc {
namespace {

using Eigen::Vector3d;

class FitLaw : public testing::TestWithParam<unsigned> {};

/// What was seen, and felt as a multiple of it beside an offset, with noise.
Pairs multiples(unsigned seed, double factor, const Vector3d& offset, double noise) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> unit(0, 1);
  Pairs pairs;
  for (int i = 0; i < 200; ++i) {
    pairs.seen.emplace_back(unit(rng), unit(rng), unit(rng));
    pairs.felt.emplace_back(factor * pairs.seen.back() + offset +
                            noise * Vector3d(unit(rng), unit(rng), unit(rng)));
  }
  return pairs;
}

TEST_P(FitLaw, FindsTheFactorAndHowWellItHolds) {
  for (const double factor : {-57.3, -1.0, 0.5, 1.0, 2.0}) {
    const Vector3d offset(3, -1, 2);
    const Pairs exact = multiples(GetParam(), factor, offset, 0);
    const Fit found = fit(exact, mean(exact.seen), mean(exact.felt), 0.1);
    EXPECT_NEAR(found.factor, factor, 1e-9 * std::abs(factor));
    EXPECT_NEAR(found.squared, factor > 0 ? 1 : -1, 1e-9);
    const Pairs noisy = multiples(GetParam(), factor, offset, std::abs(factor));
    EXPECT_NEAR(fit(noisy, mean(noisy.seen), mean(noisy.felt), 0.1).squared, factor > 0 ? 0.5 : -0.5, 0.15)
        << "of noise as large as what was seen";
  }
}

TEST_P(FitLaw, WhatHasNothingInCommonOrHardlyMovedFitsNothing) {
  const Pairs noise = multiples(GetParam(), 0, Vector3d::Zero(), 1);
  EXPECT_LT(std::abs(fit(noise, Vector3d::Zero(), Vector3d::Zero(), 0.1).squared), 0.05);
  const Pairs exact = multiples(GetParam(), 1, Vector3d::Zero(), 0);
  EXPECT_EQ(fit(exact, Vector3d::Zero(), Vector3d::Zero(), 2.0).squared, 0)
      << "rms is the square root of three";
  Pairs unfelt = exact;
  for (Vector3d& f : unfelt.felt) f.setZero();
  EXPECT_EQ(fit(unfelt, Vector3d::Zero(), Vector3d::Zero(), 0.1).factor, 0);
  EXPECT_EQ(fit({}, Vector3d::Zero(), Vector3d::Zero(), 0.1).factor, 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FitLaw, testing::Range(1U, 6U));

TEST(SeenAndFelt, TheMeanOfNothingIsZero) {
  EXPECT_EQ(mean({}), Vector3d::Zero().eval());
  EXPECT_EQ(mean({{1, 2, 3}, {3, 2, 1}}), Vector3d(2, 2, 2));
}

TEST(SeenAndFelt, AWindowHoldsTwelveRareSteps) {
  MotionRecord record;
  record.see({0, from_ms(50)});
  EXPECT_EQ(window_ns(record, from_ms(3000)), from_ms(3000));
  record.see({from_ms(50), from_ms(1050)});
  EXPECT_EQ(window_ns(record, from_ms(3000)), from_ms(12'000));
}

TEST(SeenAndFelt, ALongStepIsFeltInPiecesWhoseMeanIsTheWholes) {
  MotionRecord record;
  for (StampNs t = 0; t < from_ms(2000); t += from_ms(5))
    record.feel({t, {0, 0, 3 * to_seconds(t)}, {0, 0, 9.81}});
  const SeenStep step{from_ms(300), from_ms(1350)};
  const auto pieces = felt_in_pieces(record, step);
  ASSERT_EQ(pieces.size(), 11U) << "of a tenth of a second at most";
  Vector3d sum = Vector3d::Zero();
  for (const FeltStep& piece : pieces) sum += piece.rate_rad_s;
  EXPECT_LT((sum / 11 - record.felt(step)->rate_rad_s).norm(), 1e-6);
  EXPECT_LT(pieces.front().rate_rad_s.z(), pieces.back().rate_rad_s.z());
  EXPECT_TRUE(felt_in_pieces(record, {from_ms(1500), from_ms(2500)}).empty()) << "not all of it was felt";
}

}  // namespace
}  // namespace liloc
