// How sure the device is of its motion between requests, against how far it was off.
#include <gtest/gtest.h>

#include <algorithm>

#include "client/engine/tests/walker.hpp"
#include "common/geometry/depth.hpp"

namespace liloc {
namespace {

using namespace test;

/// Of the motion between two requests.
struct Motion {
  double error_m, error_rad, sd_m, sd_rad;
  [[nodiscard]] bool within(double deviations) const {
    return error_m <= deviations * sd_m && error_rad <= deviations * sd_rad;
  }
};

struct Walk {
  const char* name;
  bool imu;
  LocalMethod local = LocalMethod::cloud;
  bool covered = false;  ///< by a hand for a third of each second
  unsigned seeds = 10;
};

void PrintTo(const Walk& walk, std::ostream* out) {
  *out << walk.name;
}

/// The walk in room `seed`, 8 s, with a request every 0.8 s.
void add_motions(const Walk& tested, unsigned seed, std::vector<Motion>& motions) {
  EngineOptions options = engine_options();
  options.local = tested.local;
  std::vector<ImuSample> imu;
  if (tested.imu) {
    options.T_imu_sensor = mounting();
    options.still_seconds = kStillS;
    imu = scene::imu_along(walk, mounting(), 0, 8.1, 200, kStart);
  }
  Engine engine(options);
  const auto room = scene::furnished_room(seed);
  std::optional<SpotRequest> last;
  std::size_t next = 0;
  int last_frame = 0;
  for (int i = 0; i < 120; ++i) {
    for (; next < imu.size() && imu[next].stamp_ns <= stamp_of(i); ++next)
      ASSERT_TRUE(engine.add_imu(imu[next]));
    const bool covered = tested.covered && i > 30 && i % 15 < 5;
    ASSERT_TRUE(engine.add_depth(covered ? covered_at(i) : frame_at(room, i)));
    auto request = engine.take_request();
    if (!request) continue;
    if (last && last->odom_segment == request->odom_segment) {
      const Pose E = (walk(time_of(last_frame)).inverse() * walk(time_of(i))).inverse() *
                     (last->T_odom_sensor.inverse() * request->T_odom_sensor);
      motions.push_back(
          {E.translation().norm(), rotation_angle_rad(E), request->odom_sd_m, request->odom_sd_rad});
    }
    last = std::move(request);
    last_frame = i;
  }
}

class OdometryDoubt : public testing::TestWithParam<Walk> {};

TEST_P(OdometryDoubt, IsWhatTheMotionsErr) {
  std::vector<Motion> motions;
  for (unsigned seed = 1; seed <= GetParam().seeds; ++seed) add_motions(GetParam(), seed, motions);
  ASSERT_GE(motions.size(), 8U * GetParam().seeds);
  const auto within = std::ranges::count_if(motions, [](const Motion& motion) { return motion.within(3); });
  EXPECT_GE(static_cast<double>(within), 0.95 * static_cast<double>(motions.size()));
}
INSTANTIATE_TEST_SUITE_P(Methods, OdometryDoubt,
                         testing::Values(Walk{"cloud", false}, Walk{"imu", true},
                                         Walk{"cloud_covered", false, LocalMethod::cloud, true},
                                         Walk{"imu_covered", true, LocalMethod::cloud, true, 5},
                                         Walk{"inertial", true, LocalMethod::inertial, false, 5},
                                         Walk{"reckoning", true, LocalMethod::dead_reckoning, false, 5}),
                         [](const auto& tested) { return std::string(tested.param.name); });

/// 1.2 s at 0.3 m/s before a bare wall: the pose follows the guess along it.
SpotRequest beside_a_wall(bool furnished) {
  Engine engine(engine_options());
  const auto room = furnished ? scene::furnished_room(1) : scene::corridor();
  std::optional<SpotRequest> newest;
  for (int i = 0; i < 20; ++i) {
    const Pose T =
        scene::looking({furnished ? 3 + 0.02 * i : 0.02 * i, furnished ? 2.5 : 1, 1.2}, 1.5707963, 0.4);
    EXPECT_TRUE(engine.add_depth(scene::render(room, T, scene::small_camera(), stamp_of(i), 0.003)));
    if (auto request = engine.take_request()) newest = std::move(request);
  }
  return newest.value_or(SpotRequest{});
}

TEST(OdometryDoubt, GrowsAlongWhatTheSceneDoesNotShow) {
  const SpotRequest seen = beside_a_wall(true), unseen = beside_a_wall(false);
  EXPECT_GT(seen.seq, 1U);
  EXPECT_GT(unseen.seq, 1U);
  EXPECT_LT(seen.odom_sd_m, 0.02);  // no excuse where all is seen
  EXPECT_GT(unseen.odom_sd_m, 0.05);
}

}  // namespace
}  // namespace liloc
