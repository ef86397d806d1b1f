#include "client/odometry/relocate.hpp"

#include <gtest/gtest.h>

#include "common/geometry/depth.hpp"
#include "common/testing/box_room.hpp"

namespace liloc {
namespace {

std::vector<Surfel> surfels_of(const scene::BoxRoom& room, const Pose& T, StampNs stamp_ns) {
  const Camera camera = scene::small_camera();
  return extract_surfels(*depth_to_cloud(scene::render(room, T, camera, stamp_ns, 0.004), camera),
                         Eigen::Vector3f::Zero());
}

bool near(const Result<ScanMatch>& match, const Pose& T) {
  return match && distance_m(match->T_map_sensor, T) < 0.02 && angle_between_rad(match->T_map_sensor, T) < 0.01;
}

/// A place in the room and what the device sees there of it, and after it was moved.
struct Moved {
  Moved(unsigned seed, double turn_rad, const Eigen::Vector3d& shift_m) {
    const auto room = scene::furnished_room(seed);
    const Eigen::Vector3d at{2.6, 2.2, 1.2};
    T_before = scene::looking(at, 0.8 * seed, 0.2);
    T_after = scene::looking(at + shift_m, 0.8 * seed + turn_rad, 0.2);
    map.insert(T_before, surfels_of(room, T_before, 1), 1);
    frame = surfels_of(room, T_after, 2);
  }
  Pose T_before, T_after;
  LocalMap map;
  std::vector<Surfel> frame;
};

/// Of eight rooms, in how many a match and a wide one find a device that the guess says has stood.
std::pair<int, int> found(double turn_rad, const Eigen::Vector3d& shift_m) {
  int plain = 0, wide = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Moved moved(seed, turn_rad, shift_m);
    const MotionGuess guess(moved.T_before, 0.25, 0.25);
    plain += near(match_scan(moved.map, moved.frame, guess, 2), moved.T_after) ? 1 : 0;
    const auto matches = match_widely(moved.map, moved.frame, guess, 2);
    wide += !matches.empty() && near(matches.front(), moved.T_after) ? 1 : 0;
  }
  return {plain, wide};
}

TEST(MatchWidely, FindsADeviceThatTurnedOutOfTheReachOfAMatch) {
  const auto [plain, wide] = found(0.35, {0, 0, 0});
  EXPECT_GE(wide, 7);  // bare corners may fit as well
  EXPECT_GE(wide, plain + 3);
}

TEST(MatchWidely, FindsADeviceThatTurnedAndWasCarried) {
  const auto [plain, wide] = found(-0.35, {0.25, -0.2, 0});
  EXPECT_GE(wide, 6);
  EXPECT_GE(wide, plain + 3);
}

TEST(MatchWidely, PrefersWhatTheGuessSaysAmongMatchesAlikeAndTheBestComesFirst) {
  const Moved stood(3, 0, {0, 0, 0});
  const auto matches = match_widely(stood.map, stood.frame, {stood.T_before, 0.25, 0.25}, 2);
  ASSERT_FALSE(matches.empty());
  EXPECT_TRUE(near(matches.front(), stood.T_after));
  EXPECT_GE(matches.front().overlap + 0.05, matches.back().overlap);
}

TEST(MatchWidely, WithoutAMapThereIsNone) {
  const auto frame = surfels_of(scene::furnished_room(1), scene::looking({2, 2, 1}, 0), 1);
  EXPECT_TRUE(match_widely(LocalMap(), frame, {Pose::Identity(), 0.1, 0.1}, 1).empty());
}

}  // namespace
}  // namespace liloc
