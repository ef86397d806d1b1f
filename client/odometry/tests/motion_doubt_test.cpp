#include "client/odometry/motion_doubt.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace liloc {
namespace {

constexpr double kDt = 1.0 / 15, kAccel = 4, kTurn = 10;

Matrix6d seen_along(std::initializer_list<int> axes) {
  Matrix6d scene = Matrix6d::Zero();
  for (const int axis : axes) scene(axis, axis) = 1e8;
  return scene;
}

TEST(MotionDoubt, UnseenItIsTheSpreadOfWalksWhoseVelocityChangesAtRandom) {
  std::mt19937 random(1);
  std::normal_distribution<double> change(0, 0.5 * kAccel * kDt);  // of the velocity, at each step's start
  constexpr int kWalks = 2000, kSteps = 6;
  double squares = 0;
  for (int i = 0; i < kWalks; ++i) {
    double place = 0, velocity = 0;
    for (int step = 0; step < kSteps; ++step) place += kDt * (velocity += change(random));
    squares += place * place;
  }
  MotionDoubt doubt;
  for (int step = 0; step < kSteps; ++step) doubt.predict(kDt, kAccel, kTurn);
  const double spread = std::sqrt(squares / kWalks);
  EXPECT_NEAR(std::sqrt(doubt.pose()(3, 3)), spread, 0.05 * spread);
  EXPECT_NEAR(std::sqrt(doubt.pose()(0, 0) / doubt.pose()(3, 3)), kTurn / kAccel, 1e-6);
}

TEST(MotionDoubt, APoseThatIsSeenTellsTheMeanRateOfTheStep) {
  MotionDoubt doubt;
  for (int step = 0; step < 3; ++step) {
    doubt.predict(kDt, kAccel, kTurn);
    Vector6d shift;
    shift << 0.01, -0.02, 0.03, 0.004, 0.005, -0.006;
    const Vector6d rate = doubt.update(seen_along({0, 1, 2, 3, 4, 5}), shift);
    EXPECT_LT((rate - shift / kDt).norm(), 1e-3 * rate.norm());
  }
}

TEST(MotionDoubt, WhatTheSceneDoesNotShowTeachesNothingAndStaysInDoubt) {
  MotionDoubt doubt;
  double last = 0;
  for (int step = 0; step < 12; ++step) {
    doubt.predict(kDt, kAccel, kTurn);
    Vector6d shift = Vector6d::Constant(0.01);
    shift[3] = 0;  // the match followed the guess there
    const Vector6d rate = doubt.update(seen_along({0, 1, 2, 4, 5}), shift);
    EXPECT_LT(std::abs(rate[3]), 1e-9);
    EXPECT_NEAR(rate[4], 0.01 / kDt, 1e-3);
    EXPECT_GT(doubt.pose()(3, 3), last);
    EXPECT_LT(doubt.pose()(4, 4), 1e-7);
    last = doubt.pose()(3, 3);
  }
  doubt.predict(kDt, kAccel, kTurn);
  EXPECT_LE(std::sqrt(doubt.pose()(3, 3)), std::sqrt(last) + 1.2 * kDt);  // 1 m/s at most
  EXPECT_LT(std::abs(doubt.update(seen_along({3}), Vector6d::Constant(0.3))[3]), 0.3 / kDt / 2);
  EXPECT_LT(doubt.pose()(3, 3), 1e-7);  // a corner comes into view
}

}  // namespace
}  // namespace liloc
