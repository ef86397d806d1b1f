#include "client/odometry/match_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/geometry/depth.hpp"
#include "common/testing/walk.hpp"

namespace liloc {
namespace {

using namespace test;

constexpr double kSureM = 0.02, kWidePriorM = 0.5;

/// A map of one view of room 1, and the same view after somebody who stood in it perhaps has left.
struct Scene {
  explicit Scene(bool somebody) {
    options.camera = scene::small_camera();
    auto room = scene::furnished_room(1);
    image = scene::render(room, walk(0), options.camera, 2, 0.004);
    if (somebody) room.furniture.push_back({{4.6, 2.0, 0}, {4.9, 3.2, 1.8}});
    const auto cloud = depth_to_cloud(scene::render(room, walk(0), options.camera, 1, 0.004), options.camera);
    map.insert(Pose::Identity(), extract_surfels(*cloud, Eigen::Vector3f::Zero()), 1);
    match.overlap = match.paired = 0.9;
    match.stop = ScanStop::converged;
  }
  [[nodiscard]] bool doubtful(double guess_sd_m) const {
    const MotionGuess guess(Pose::Identity(), guess_sd_m, guess_sd_m);
    return MatchCheck(map, image, guess, options).doubtful(match);
  }
  [[nodiscard]] double merit(const Pose& T_map_sensor) const {
    ScanMatch there = match;
    there.T_map_sensor = T_map_sensor;
    const MotionGuess guess(Pose::Identity(), 0.1, kWidePriorM);
    return MatchCheck(map, image, guess, options).merit(there);
  }

  OdometryOptions options;
  LocalMap map;
  DepthImage image;
  ScanMatch match;
};

TEST(MatchCheck, WhatConvergesIsNotDoubtfulNorWhatDoesNotWhereNobodyMoves) {
  Scene still(false), people(true);
  EXPECT_FALSE(still.doubtful(kSureM));
  EXPECT_FALSE(people.doubtful(kSureM));
  still.match.stop = people.match.stop = ScanStop::iteration_limit;
  EXPECT_FALSE(still.doubtful(kSureM));
  EXPECT_TRUE(people.doubtful(kSureM));
}

TEST(MatchCheck, FromAWidePriorAllMustSpeakForTheMatch) {
  Scene still(false);
  EXPECT_FALSE(still.doubtful(kWidePriorM));
  EXPECT_TRUE(Scene(true).doubtful(kWidePriorM));
  still.match.unobserved = 1;
  EXPECT_TRUE(still.doubtful(kWidePriorM));
  EXPECT_FALSE(still.doubtful(kSureM));  // a good guess knows that axis
  still.match.unobserved = 0;
  still.match.overlap = 0.4;
  EXPECT_TRUE(still.doubtful(kWidePriorM));
}

TEST(MatchCheck, OfMatchesWithOneOverlapTheNearerThatSeesNothingThroughIsTheBetter) {
  const Scene still(false);
  const Pose near(Eigen::Translation3d(0, 0, 0.01)), forth(Eigen::Translation3d(0, 0, 0.6)),
      back(Eigen::Translation3d(0, 0, -0.6));
  EXPECT_GT(still.merit(Pose::Identity()), still.merit(near));
  EXPECT_LT(still.merit(Pose::Identity()) - still.merit(near), 1e-3);
  // From there the map would stand before what the image shows, or behind it.
  EXPECT_GT(std::abs(still.merit(forth) - still.merit(back)), 0.1);
  EXPECT_GT(still.merit(near), std::max(still.merit(forth), still.merit(back)));
}

}  // namespace
}  // namespace liloc
