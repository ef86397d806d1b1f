#include "client/src/relocate.hpp"

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

/// The device turned to the left while the guess says that it stood. Bare corners may fit as well.
TEST(MatchTurned, FindsADeviceThatTurnedOutOfTheReachOfAMatch) {
  int plain = 0, turned = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const auto room = scene::furnished_room(seed);
    const Pose T = scene::looking({2.6, 2.2, 1.2}, 0.8 * seed, 0.2);
    const Pose T_now = scene::looking({2.6, 2.2, 1.2}, 0.8 * seed + 0.35, 0.2);
    LocalMap map;
    map.insert(T, surfels_of(room, T, 1), 1);
    const auto frame = surfels_of(room, T_now, 2);
    plain += near(match_scan(map, frame, {T, 0.25, 0.1}, 2), T_now) ? 1 : 0;
    turned += near(match_turned(map, frame, {T, 0.25, 0.1}, 2), T_now) ? 1 : 0;
  }
  EXPECT_GE(turned, 7);
  EXPECT_GE(turned, plain + 3);
}

TEST(MatchTurned, WithoutAMapItIsAnError) {
  const auto frame = surfels_of(scene::furnished_room(1), scene::looking({2, 2, 1}, 0), 1);
  EXPECT_FALSE(match_turned(LocalMap(), frame, {Pose::Identity(), 0.1, 0.1}, 1));
}

}  // namespace
}  // namespace liloc
