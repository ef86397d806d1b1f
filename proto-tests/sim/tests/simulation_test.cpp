#include "proto-tests/sim/simulation.hpp"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>

#include "common/geometry/depth.hpp"
#include "common/geometry/voxel.hpp"

namespace liloc::sim {
namespace {

SimOptions small(std::uint64_t seed) {
  SimOptions options;
  options.seed = seed;
  options.seconds = 4;
  options.still_seconds = 1;
  options.image_width = 80;
  options.image_height = 60;
  return options;
}

std::vector<SimEvent> all_events(const SimOptions& options) {
  auto simulation = Simulation::create(options);
  EXPECT_TRUE(simulation) << simulation.error().message;
  std::vector<SimEvent> events;
  while (auto event = simulation->next()) events.push_back(std::move(*event));
  return events;
}

/// Everything that an event says, as one number.
std::uint64_t digest(const std::vector<SimEvent>& events) {
  std::uint64_t sum = 1469598103934665603ULL;
  const auto add = [&](std::uint64_t value) { sum = (sum ^ value) * 1099511628211ULL; };
  for (const SimEvent& event : events) {
    add(static_cast<std::uint64_t>(event.at_ns));
    if (const auto* lidar = std::get_if<LidarFrame>(&event.payload))
      for (const auto unit : lidar->image.units) add(unit);
    if (const auto* device = std::get_if<DeviceFrame>(&event.payload))
      for (const auto unit : device->image.units) add(unit);
    if (const auto* imu = std::get_if<DeviceImu>(&event.payload))
      for (const double value : imu->sample.specific_force_m_s2) add(std::bit_cast<std::uint64_t>(value));
  }
  return sum;
}

TEST(Simulation, FollowsFromItsSeedAloneWhateverTheThreads) {
  SimOptions two_threads = small(21);
  two_threads.threads = 2;
  const auto once = digest(all_events(small(21)));
  EXPECT_EQ(once, digest(all_events(small(21))));
  EXPECT_EQ(once, digest(all_events(two_threads)));
  EXPECT_NE(once, digest(all_events(small(22))));
}

TEST(Simulation, DeliversEverySensorInOrderAtItsRate) {
  SimOptions options = small(23);
  options.lidars = 4;
  options.devices = 2;
  const auto events = all_events(options);
  int lidar = 0, device = 0, imu = 0;
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_GE(events[i].at_ns, events[i > 0 ? i - 1 : 0].at_ns);
    lidar += std::holds_alternative<LidarFrame>(events[i].payload) ? 1 : 0;
    device += std::holds_alternative<DeviceFrame>(events[i].payload) ? 1 : 0;
    imu += std::holds_alternative<DeviceImu>(events[i].payload) ? 1 : 0;
  }
  EXPECT_NEAR(lidar, 4 * 6 * 4, 4);
  EXPECT_NEAR(device, 2 * 15 * 4, 2);
  EXPECT_NEAR(imu, 2 * 200 * 4, 2);
}

TEST(Simulation, ClockOffsetGapAndBlockedViewComeAsAsked) {
  SimOptions options = small(24);
  options.device_clock_offset_ms = 70;
  options.ceiling_gap_start_s = 1;
  options.ceiling_gap_seconds = 1.5;
  options.blocked_start_s = 2;
  options.blocked_seconds = 1;
  auto simulation = Simulation::create(options);
  ASSERT_TRUE(simulation) << simulation.error().message;
  int blocked = 0;
  while (const auto event = simulation->next()) {
    const double time_s = to_seconds(event->at_ns - simulation->start_ns());
    EXPECT_FALSE(std::holds_alternative<LidarFrame>(event->payload) && time_s >= 1 && time_s < 2.5) << time_s;
    if (const auto* device = std::get_if<DeviceFrame>(&event->payload)) {
      EXPECT_EQ(device->image.stamp_ns - event->at_ns, from_ms(70));
      const int middle = device->image.at(40, 30);
      const bool near = middle < 300;  // 0 where the beam was lost
      if (time_s >= 2 && time_s < 3) {
        EXPECT_TRUE(near) << middle;
        ++blocked;
      }
    }
  }
  EXPECT_GT(blocked, 10);
}

class EverySite : public testing::TestWithParam<std::tuple<SiteKind, int>> {};

TEST_P(EverySite, CanBeWalkedInAndIsSeenFromAboveAndBelow) {
  SimOptions options = small(static_cast<std::uint64_t>(std::get<1>(GetParam())));
  options.kind = std::get<0>(GetParam());
  options.seconds = 12;
  options.people = 3;
  options.lidar_rate_hz = 0.5;
  options.device_rate_hz = 1;
  auto simulation = Simulation::create(options);
  ASSERT_TRUE(simulation) << simulation.error().message;
  EXPECT_GT(
      (simulation->T_map_sensor(0, 12).translation() - simulation->T_map_sensor(0, 0).translation()).norm() +
          (simulation->T_map_sensor(0, 6).translation() - simulation->T_map_sensor(0, 0).translation()).norm(),
      0.3);
  while (const auto event = simulation->next()) {
    const auto* frame = std::get_if<LidarFrame>(&event->payload);
    if (frame == nullptr) continue;
    const GlobalLidar& lidar = simulation->site().global_lidars[frame->lidar];
    const auto cloud = depth_to_cloud(frame->image, lidar.camera);
    ASSERT_TRUE(cloud);
    EXPECT_GT(cloud->size(), 1000u) << lidar.id;
    int below = 0;
    for (const auto& p : transformed(lidar.T_map_sensor, *cloud).points) below += p.z() < -0.1F ? 1 : 0;
    EXPECT_LT(below, 5) << "no point lies under the floor";
  }
  const auto scan = simulation->reference_scan();
  ASSERT_TRUE(scan) << scan.error().message;
  EXPECT_GT(scan->size(), 50'000u);
}
INSTANTIATE_TEST_SUITE_P(KindsAndSeeds, EverySite,
                         testing::Combine(testing::Values(SiteKind::office, SiteKind::corridor,
                                                          SiteKind::symmetric, SiteKind::area),
                                          testing::Range(1, 4)));

/// How much larger the furniture of a site gets when its half-turned twin is laid over it; 1: it is its own
/// twin.
double growth_by_half_turn(SiteKind kind, std::uint64_t seed) {
  SimOptions options = small(seed);
  options.kind = kind;
  options.width_m = 10;
  options.depth_m = 8;
  options.height_m = 3.5;
  const auto simulation = Simulation::create(options);
  EXPECT_TRUE(simulation) << simulation.error().message;
  const auto scan = simulation->reference_scan();
  EXPECT_TRUE(scan) << scan.error().message;
  Cloud furniture, both;
  for (const auto& p : scan->points)
    if (p.z() > 0.3F && p.z() < 2 && p.x() > 0.2F && p.x() < 9.8F && p.y() > 0.2F && p.y() < 7.8F)
      furniture.points.push_back(p);
  both = furniture;
  for (const auto& p : furniture.points) both.points.emplace_back(10 - p.x(), 8 - p.y(), p.z());
  const double voxel = 0.2;
  return static_cast<double>(voxel_downsample(both, voxel).size()) /
         static_cast<double>(voxel_downsample(furniture, voxel).size());
}

TEST(Simulation, OnlyTheSymmetricSiteIsItsOwnTwinAfterHalfATurn) {
  for (const std::uint64_t seed : {25, 26}) {
    EXPECT_LT(growth_by_half_turn(SiteKind::symmetric, seed), 1.05) << seed;
    EXPECT_GT(growth_by_half_turn(SiteKind::office, seed), 1.5) << seed;
  }
}

struct BadOption {
  const char* field;
  void (*spoil)(SimOptions&);
};

class BadOptions : public testing::TestWithParam<BadOption> {};

TEST_P(BadOptions, AreNamed) {
  SimOptions options = small(26);
  GetParam().spoil(options);
  const auto simulation = Simulation::create(options);
  ASSERT_FALSE(simulation);
  EXPECT_THAT(simulation.error().message, testing::HasSubstr(GetParam().field));
}
INSTANTIATE_TEST_SUITE_P(
    Fields, BadOptions,
    testing::Values(BadOption{"width_m", [](SimOptions& o) { o.width_m = 1; }},
                    BadOption{"height_m", [](SimOptions& o) { o.height_m = std::nan(""); }},
                    BadOption{"people", [](SimOptions& o) { o.people = -1; }},
                    BadOption{"lidars", [](SimOptions& o) { o.lidars = 9; }},
                    BadOption{"devices", [](SimOptions& o) { o.devices = 17; }},
                    BadOption{"seconds", [](SimOptions& o) { o.seconds = 0; }},
                    BadOption{"fov_x_deg", [](SimOptions& o) { o.fov_x_deg = 180; }},
                    BadOption{"depth_scale_m", [](SimOptions& o) { o.depth_scale_m = 0; }},
                    BadOption{"imu_rate_hz", [](SimOptions& o) { o.imu_rate_hz = 1e9; }},
                    BadOption{"threads", [](SimOptions& o) { o.threads = 0; }},
                    BadOption{"start_stamp_ns", [](SimOptions& o) { o.start_stamp_ns = -5; }}),
    [](const auto& bad) { return std::string(bad.param.field); });

TEST(Options, KindsByName) {
  EXPECT_EQ(*site_kind_of("area"), SiteKind::area);
  EXPECT_EQ(*device_kind_of("robot"), DeviceKind::robot);
  EXPECT_THAT(site_kind_of("attic").error().message, testing::HasSubstr("attic"));
  EXPECT_FALSE(device_kind_of(""));
}

}  // namespace
}  // namespace liloc::sim
