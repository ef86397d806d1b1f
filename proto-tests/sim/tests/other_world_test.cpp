#include <gmock/gmock.h>

#include <algorithm>
#include <numeric>

#include "common/geometry/depth.hpp"
#include "proto-tests/sim/motion/other_people.hpp"
#include "proto-tests/sim/simulation.hpp"

namespace liloc::sim {
namespace {

SimOptions small(SiteKind kind, std::uint64_t seed, int world) {
  SimOptions options;
  options.kind = kind;
  options.seed = seed;
  options.world = world;
  options.seconds = 3;
  options.people = 3;
  options.image_width = 80;
  options.image_height = 60;
  return options;
}

struct FirstFrames {
  SiteKind kind;
  int lidar_returns;
  double lidar_mean_mm;
  int device_returns;
  double device_mean_mm;
};

/// Returns and mean depth of a frame; a processor with other vector units may round a ray differently.
std::pair<int, double> summary(const DepthImage& image) {
  const auto returns = std::ranges::count_if(image.units, [](std::uint16_t unit) { return unit > 0; });
  return {static_cast<int>(returns),
          std::accumulate(image.units.begin(), image.units.end(), 0.0) / static_cast<double>(returns)};
}

class WorldOne : public testing::TestWithParam<FirstFrames> {};

TEST_P(WorldOne, IsAsItAlwaysWas) {  // figures of commit 5938307
  SimOptions options = small(GetParam().kind, 77, 1);
  options.devices = 2;
  auto simulation = Simulation::create(options);
  ASSERT_TRUE(simulation);
  bool lidar = false, device = false;
  while (const auto event = simulation->next()) {
    if (const auto* frame = std::get_if<LidarFrame>(&event->payload); frame && frame->lidar == 0 && !lidar) {
      const auto [returns, mean_mm] = summary(frame->image);
      EXPECT_NEAR(returns, GetParam().lidar_returns, 3);
      EXPECT_NEAR(mean_mm, GetParam().lidar_mean_mm, 1);
      lidar = true;
    }
    if (const auto* frame = std::get_if<DeviceFrame>(&event->payload); frame && frame->device == 0 && !device) {
      const auto [returns, mean_mm] = summary(frame->image);
      EXPECT_NEAR(returns, GetParam().device_returns, 3);
      EXPECT_NEAR(mean_mm, GetParam().device_mean_mm, 1);
      device = true;
    }
  }
  EXPECT_TRUE(lidar && device);
}
INSTANTIATE_TEST_SUITE_P(Kinds, WorldOne,
                         testing::Values(FirstFrames{SiteKind::office, 3357, 4989.4, 2481, 2697.3},
                                         FirstFrames{SiteKind::corridor, 4442, 3114.1, 3952, 2587.9},
                                         FirstFrames{SiteKind::symmetric, 3503, 5045.5, 3182, 2489.9},
                                         FirstFrames{SiteKind::area, 2784, 4577.9, 2041, 2405.9}));

class WorldTwo : public testing::TestWithParam<std::tuple<SiteKind, int>> {
 protected:
  [[nodiscard]] SimOptions options() const {
    return small(std::get<0>(GetParam()), static_cast<std::uint64_t>(std::get<1>(GetParam())), 2);
  }
};

TEST_P(WorldTwo, CanBeWalkedInAndIsSeenFromAboveAndBelow) {
  SimOptions crowded = options();
  crowded.people = 6;
  crowded.lidar_rate_hz = crowded.device_rate_hz = 1;
  auto simulation = Simulation::create(crowded);
  ASSERT_TRUE(simulation) << simulation.error().message;
  while (const auto event = simulation->next()) {
    const auto* frame = std::get_if<LidarFrame>(&event->payload);
    if (frame == nullptr) continue;
    const GlobalLidar& lidar = simulation->site().global_lidars[frame->lidar];
    const auto cloud = depth_to_cloud(frame->image, lidar.camera);
    ASSERT_TRUE(cloud);
    EXPECT_GT(cloud->size(), 500U) << lidar.id;
    int below = 0;
    for (const auto& p : transformed(lidar.T_map_sensor, *cloud).points) below += p.z() < -0.1F ? 1 : 0;
    EXPECT_LT(below, 5) << "no point lies under the floor";
  }
}
TEST_P(WorldTwo, IsAnotherSiteThanWorldOnes) {
  SimOptions one = options();
  one.world = 1;
  const auto a = Simulation::create(one), b = Simulation::create(options());
  ASSERT_TRUE(a && b);
  EXPECT_FALSE(a->site().global_lidars[0].T_map_sensor.isApprox(b->site().global_lidars[0].T_map_sensor, 1e-3));
}
TEST_P(WorldTwo, FollowsFromItsSeed) {
  auto a = Simulation::create(options()), b = Simulation::create(options());
  ASSERT_TRUE(a && b);
  for (int i = 0; i < 30; ++i) {
    const auto x = a->next(), y = b->next();
    ASSERT_TRUE(x && y);
    const auto* p = std::get_if<LidarFrame>(&x->payload);
    if (p != nullptr) {
      EXPECT_EQ(p->image.units, std::get<LidarFrame>(y->payload).image.units);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(KindsAndSeeds, WorldTwo,
                         testing::Combine(testing::Values(SiteKind::office, SiteKind::corridor,
                                                          SiteKind::symmetric, SiteKind::area),
                                          testing::Range(1, 5)));

TEST(Visitors, StandInGroupsSitAndHurry) {
  SimOptions options = small(SiteKind::area, 3, 2);
  Random random(5, 1);
  const FloorPlan plan(make_layout(options), 0.38);
  const auto crowd = draw_visitors(random, plan, 200);
  ASSERT_EQ(crowd.size(), 200U);
  const auto share = [&](Posture posture) {
    return static_cast<double>(std::ranges::count(crowd, posture, &Visitor::posture)) / 200;
  };
  EXPECT_GT(share(Posture::walking), 0.1);
  EXPECT_GT(share(Posture::standing), 0.3);
  EXPECT_GT(share(Posture::sitting), 0.02);
  for (const Visitor& visitor : crowd)
    EXPECT_EQ(visitor.style.start.has_value(), visitor.posture != Posture::walking);
}

TEST(Visitors, GestureWithArmsAlone) {
  Random random(8, 1);
  for (int i = 0; i < 20; ++i) {
    const Body body = Body::visitor(random, Posture::standing);
    if (body.gesture_hz() == 0) continue;
    const auto moved = [&](std::size_t part) {
      return (body.T_map_part(part, Pose::Identity(), 0.0, 1).linear() -
              body.T_map_part(part, Pose::Identity(), 1.5, 1).linear())
          .norm();
    };
    EXPECT_GT(moved(1), 0.1);  // an arm
    EXPECT_EQ(moved(2), 0);    // a leg
  }
}

}  // namespace
}  // namespace liloc::sim
