#include "client/engine/request_maker.hpp"

#include <gtest/gtest.h>

#include "client/engine/tests/walker.hpp"
#include "common/codec/codec.hpp"
#include "common/geometry/depth.hpp"

namespace liloc {
namespace {

using namespace test;

/// A straight path along x, 0.1 m a frame, turning by 0.02 rad a frame.
OdometryStep step_of(int frame, std::uint32_t segment = 0) {
  OdometryStep step;
  step.T_odom_sensor =
      Eigen::Translation3d(50 + 0.1 * frame, 0, 0) * Eigen::AngleAxisd(0.02 * frame, Eigen::Vector3d::UnitZ());
  step.segment = segment;
  return step;
}

class Requests : public testing::Test {
 protected:
  void travel(int from, int to, std::uint32_t segment = 0) {
    for (int i = from; i < to; ++i) maker.travelled(stamp_of(i), step_of(i, segment), i % 2 == 0);
  }
  SpotRequest make() {
    const auto request = maker.make(cloud, surroundings, nullptr);
    EXPECT_TRUE(request) << request.error().message;
    return request.value_or(SpotRequest{});
  }
  const Cloud cloud = *depth_to_cloud(frame_at(scene::furnished_room(1), 0), scene::small_camera());
  const LocalMap surroundings{{}};
  RequestMaker maker{engine_options()};
};

TEST_F(Requests, TellOfThePathSinceTheLastOne) {
  travel(0, 5);
  const SpotRequest first = make();
  travel(5, 7);
  const SpotRequest second = make();
  ASSERT_EQ(first.local_poses.size(), 5U);
  ASSERT_EQ(second.local_poses.size(), 2U);
  EXPECT_EQ(second.local_poses.front().stamp_ns, stamp_of(5));
  EXPECT_FALSE(second.local_poses.front().informative);
  EXPECT_TRUE(second.local_poses.back().informative);
  EXPECT_EQ(second.stamp_ns, stamp_of(6));
  EXPECT_EQ(second.seq, first.seq + 1);
  EXPECT_TRUE(second.T_odom_sensor.isApprox(step_of(6).T_odom_sensor));
}

TEST_F(Requests, AreLessSureTheFartherTheDeviceWent) {
  travel(0, 1);
  const SpotRequest here = make();  // 50 m from odom's origin, which is no path
  travel(1, 2);
  const SpotRequest near = make();
  travel(2, 42);
  const SpotRequest far = make();
  travel(42, 43);
  const SpotRequest again = make();
  EXPECT_LT(here.odom_sd_m, near.odom_sd_m);
  // A wrong scale errs by a share of the path and of the turn.
  EXPECT_NEAR(near.odom_sd_m, std::hypot(here.odom_sd_m, 0.005 * 0.1), 1e-9);
  EXPECT_NEAR(far.odom_sd_m, std::hypot(here.odom_sd_m, 0.005 * 4), 1e-9);
  EXPECT_NEAR(far.odom_sd_rad, std::hypot(here.odom_sd_rad, 0.005 * 0.8), 1e-9);
  EXPECT_NEAR(again.odom_sd_m, near.odom_sd_m, 1e-12);
}

TEST_F(Requests, TellWhatTheOdometryDoubts) {
  OdometryStep step = step_of(0);
  step.sd_m = 0.3;
  step.sd_rad = 0.05;
  maker.travelled(stamp_of(0), step, true);
  const SpotRequest request = make();
  EXPECT_NEAR(request.odom_sd_m, 0.3, 1e-3);
  EXPECT_NEAR(request.odom_sd_rad, 0.05, 1e-3);
}

/// A wall behind the device, seen long ago.
LocalMap wall_behind() {
  std::vector<Surfel> wall;
  for (int i = 0; i < 400; ++i) {
    Surfel surfel;
    surfel.mean = {0.2F * static_cast<float>(i % 20) - 2, 0.1F * static_cast<float>(i / 20) - 1, -2};
    surfel.normal = Eigen::Vector3f::UnitZ();
    surfel.count = 20;
    wall.push_back(surfel);
  }
  LocalMap map{{}};
  for (const int frame : {0, 1, 2}) map.insert(Pose::Identity(), wall, stamp_of(frame));
  return map;
}

TEST_F(Requests, OfALocatedDeviceHoldSurroundingsThatOdometryPlacedWell) {
  const LocalMap wall = wall_behind();
  const auto extra_of = [&](double sd_m, bool located) {
    RequestMaker fresh{engine_options()};
    OdometryStep step;
    step.sd_m = sd_m;
    fresh.travelled(stamp_of(60), step, true);
    const auto request = fresh.make(cloud, wall, nullptr, located);
    EXPECT_TRUE(request) << request.error().message;
    return request ? request->extra.bytes.size() : 0;
  };
  EXPECT_GT(extra_of(0.001, true), 0U);
  EXPECT_EQ(extra_of(0.1, true), 0U) << "the wall may be anywhere by now";
  EXPECT_EQ(extra_of(0.1, false), extra_of(0.001, true)) << "whoever is lost needs all there is";
}

TEST_F(Requests, OfANewSegmentHoldItsSurroundingsWhateverWasUnsureBefore) {
  OdometryStep step;
  step.sd_m = 0.1;
  maker.travelled(stamp_of(60), step, true);
  (void)make();
  step = {};
  step.segment = 1;
  maker.travelled(stamp_of(40), step, true);  // the device's clock was set back
  const auto request = maker.make(cloud, wall_behind(), nullptr, true);
  ASSERT_TRUE(request) << request.error().message;
  EXPECT_FALSE(request->extra.bytes.empty());
}

TEST_F(Requests, SayNothingOfASegmentThatBroke) {
  travel(0, 20);
  travel(20, 21, 1);
  const SpotRequest request = make();
  EXPECT_EQ(request.odom_segment, 1U);
  EXPECT_EQ(request.local_poses.size(), 1U);
  travel(21, 22, 1);
  EXPECT_LT(request.odom_sd_m, make().odom_sd_m);  // nor was the step between the segments travelled
}

TEST_F(Requests, HoldTheNewestOfALongSilence) {
  travel(0, 400);
  const SpotRequest request = make();
  EXPECT_EQ(request.local_poses.size(), 250U);
  EXPECT_EQ(request.local_poses.back().stamp_ns, stamp_of(399));
  EXPECT_EQ(request.local_poses.front().stamp_ns, stamp_of(150));
}

TEST_F(Requests, HoldMorePointsWhereVoxelsAreFiner) {
  Cloud wall;  // 6 m x 4 m, more than 4000 points at any of these voxel sizes
  for (float x = -3; x < 3; x += 0.01F)
    for (float y = -2; y < 2; y += 0.01F) wall.points.emplace_back(x, y, 4.0F);
  const auto points_at = [&](double voxel_size_m) {
    EngineOptions options = engine_options();
    options.voxel_size_m = voxel_size_m;
    options.request_bytes = 60'000;
    RequestMaker finer{options};
    finer.travelled(stamp_of(0), step_of(0), true);
    return decode(finer.make(wall, surroundings, nullptr).value().lpc).value().size();
  };
  EXPECT_LE(points_at(0.05), 4000U);
  EXPECT_GT(points_at(0.03), 2.0 * static_cast<double>(points_at(0.05)));
  EXPECT_LE(points_at(0.03), 4000 * 25 / 9U);
}

TEST_F(Requests, AFrameThatCannotBeSentIsStillTravelled) {
  travel(0, 3);
  EXPECT_FALSE(maker.make(Cloud{}, surroundings, nullptr));
  travel(3, 4);
  const SpotRequest request = make();
  EXPECT_EQ(request.seq, 1U);
  EXPECT_EQ(request.local_poses.size(), 4U);
}

}  // namespace
}  // namespace liloc
