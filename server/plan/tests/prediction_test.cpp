#include "server/plan/prediction.hpp"

#include <gtest/gtest.h>

namespace liloc::plan {
namespace {

TEST(Support, TellsTheDirectionThatHoldsLeast) {
  Support support;
  for (int i = 0; i < 10; ++i) support.add({1, 0, 0});
  EXPECT_NEAR(support.weakest(), 0, 1e-9);
  for (int i = 0; i < 4; ++i) support.add({0, -1, 0});
  EXPECT_NEAR(support.weakest(), 4, 1e-6);
  for (int i = 0; i < 50; ++i) support.add({0, 0, 1});
  EXPECT_NEAR(support.weakest(), 4, 1e-6);
  EXPECT_EQ(support.covered, 64);
  EXPECT_EQ(support.upright, 14);
}

TEST(Support, IsTheSameWhicheverWayTheRoomIsTurned) {
  Support straight, turned;
  const Eigen::AngleAxisf turn(0.7F, Eigen::Vector3f::UnitZ());
  for (const Eigen::Vector3f& n :
       {Eigen::Vector3f(1, 0, 0), Eigen::Vector3f(1, 0, 0), Eigen::Vector3f(0, 1, 0)}) {
    straight.add(n);
    turned.add(turn * n);
  }
  EXPECT_NEAR(straight.weakest(), turned.weakest(), 1e-5);
}

ViewFeatures view(double covered_share, double alike) {
  ViewFeatures f;
  f.seen = 800;
  f.alike = alike;
  const int covered = static_cast<int>(covered_share * f.seen);
  for (int i = 0; i < covered; ++i)
    f.support.add(i % 2 == 0   ? Eigen::Vector3f::UnitZ()
                  : i % 4 == 1 ? Eigen::Vector3f::UnitX()
                               : Eigen::Vector3f::UnitY());
  return f;
}

TEST(ChanceVerified, GrowsWithWhatIsCoveredAndIsAProbability) {
  double before = 0;
  for (const double covered : {0.0, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0}) {
    const double chance = chance_verified(view(covered, 0.6));
    EXPECT_GE(chance, before);
    EXPECT_LE(chance, 1);
    before = chance;
  }
  EXPECT_GT(before, 0.6);
  EXPECT_EQ(chance_verified(view(0, 0)), 0);
}

TEST(ChanceVerified, AViewOfNearlyNothingHasNone) {
  ViewFeatures nothing = view(1, 0);
  nothing.seen = 10;
  EXPECT_EQ(chance_verified(nothing), 0);
}

}  // namespace
}  // namespace liloc::plan
