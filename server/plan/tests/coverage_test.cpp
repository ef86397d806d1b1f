#include "server/plan/coverage.hpp"

#include <gmock/gmock.h>

#include "server/plan/tests/scanned_room.hpp"

namespace liloc::plan {
namespace {

class CoverageLaw : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    room_.emplace(VoxelRoom::create(test::scan_of_two_rooms()).value());
    const FreeFloor floor = find_free_floor(*room_, test::few_places()).value();
    devices_ = look_around(*room_, floor, test::small_device(), [](double) {});
  }
  static std::vector<Surface> lidar(double x, double y, double azimuth_deg) {
    return SensorRays(scene::small_camera(), kLidarRange_m)
        .seen(*room_, looking({x, y, 2.8}, radians(azimuth_deg), radians(35)));
  }
  inline static std::optional<VoxelRoom> room_;
  inline static DeviceViews devices_;
};

TEST_F(CoverageLaw, ALidarMoreNeverLowersCoverageOrWhatSupportsAView) {
  Coverage coverage(*room_, devices_);
  double before = 0, localizable = 0;
  std::vector<double> covered(devices_.views.size(), 0);
  for (const auto& [x, y, azimuth] :
       {std::tuple{0.3, 0.3, 45.0}, {7.7, 5.7, 225.0}, {4, 5.7, 200.0}, {7.7, 0.3, 135.0}}) {
    coverage.add(lidar(x, y, azimuth));
    EXPECT_GE(coverage.covered_share(), before);
    EXPECT_GE(coverage.localizable_share(), localizable);
    before = coverage.covered_share();
    localizable = coverage.localizable_share();
    for (std::size_t i = 0; i < covered.size(); ++i) {
      EXPECT_GE(coverage.features(i).support.covered, covered[i]);
      covered[i] = coverage.features(i).support.covered;
      EXPECT_LE(covered[i], coverage.features(i).seen);
    }
  }
  EXPECT_GT(before, 0.2);
}

TEST_F(CoverageLaw, OneTakenAwayIsAsIfItHadNeverBeen) {
  Coverage coverage(*room_, devices_), other(*room_, devices_);
  coverage.add(lidar(0.3, 0.3, 45));
  other.add(lidar(0.3, 0.3, 45));
  coverage.add(lidar(7.7, 5.7, 225));
  coverage.remove(lidar(7.7, 5.7, 225));
  EXPECT_EQ(coverage.covered_share(), other.covered_share());
  EXPECT_NEAR(coverage.localizable_share(), other.localizable_share(), 1e-9);
}

TEST_F(CoverageLaw, ATrialTellsWhatAddingBrings) {
  Coverage coverage(*room_, devices_);
  coverage.add(lidar(0.3, 0.3, 45));
  const double told = coverage.share_with(lidar(0.3, 5.7, -45));
  coverage.add(lidar(0.3, 5.7, -45));
  EXPECT_NEAR(coverage.localizable_share(), told, 1e-9);
}

TEST_F(CoverageLaw, WhatTheWallHidesStaysBlind) {
  Coverage coverage(*room_, devices_);
  for (const double y : {1.5, 3.5, 5.5})
    for (const double azimuth : {20.0, -20.0, 90.0, -90.0}) coverage.add(lidar(0.3, y, azimuth));
  double left = 0, right = 0;
  for (std::size_t i = 0; i < devices_.views.size(); ++i)
    (devices_.views[i].T_map_sensor.translation().x() < 4.4 ? left : right) += coverage.chance(i);
  EXPECT_GT(left, 5 * right);
}

TEST_F(CoverageLaw, WithoutLidarsNothingIsLocalizable) {
  const Coverage coverage(*room_, devices_);
  EXPECT_EQ(coverage.covered_share(), 0);
  EXPECT_EQ(coverage.localizable_share(), 0);
}

}  // namespace
}  // namespace liloc::plan
