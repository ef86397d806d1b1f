#include "proto-tests/soak/tape.hpp"

#include <gmock/gmock.h>

#include <map>
#include <set>

namespace liloc::soak {
namespace {

Tape tape_of(std::vector<double> times_s, double seconds) {
  Tape tape;
  tape.seconds = seconds;
  for (const double at_s : times_s) tape.events.push_back({at_s, sim::DeviceImu{}});
  return tape;
}

TEST(SoakTape, IsPlayedToAndFroAndTimeRises) {
  const Tape tape = tape_of({0, 1, 3, 4}, 4);
  TapePlayer player(tape);
  double last_s = -1;
  std::vector<double> played;
  for (int i = 0; i < 12; ++i) {
    const auto moment = player.next();
    EXPECT_GT(moment.at_s, last_s) << "equal stamps would be refused";
    last_s = moment.at_s;
    EXPECT_EQ(moment.backwards, i / 4 == 1);
    played.push_back(moment.event->at_s);
  }
  EXPECT_THAT(played, testing::ElementsAre(0, 1, 3, 4, 4, 3, 1, 0, 0, 1, 3, 4));
  EXPECT_NEAR(last_s, 12, 0.5) << "three laps of 4 s";
}

TEST(SoakTape, BackwardsTheGyroTurnsAboutAndGravityStays) {
  const ImuSample sample{7, {1, -2, 3}, {0, 0, 9.8}};
  const ImuSample back = reversed(sample);
  EXPECT_EQ(back.stamp_ns, 7);
  EXPECT_EQ(back.angular_velocity_rad_s, Eigen::Vector3d(-1, 2, -3));
  EXPECT_EQ(back.specific_force_m_s2, sample.specific_force_m_s2);
}

TEST(SoakTape, HoldsAllSensorsOfASite) {
  SoakOptions options;
  options.tape_s = 6;
  const auto tape = record_tape(options, {});
  ASSERT_TRUE(tape) << tape.error().message;
  std::set<std::size_t> lidars, devices;
  for (const TapeEvent& event : tape->events) {
    if (const auto* frame = std::get_if<sim::LidarFrame>(&event.payload)) lidars.insert(frame->lidar);
    if (const auto* frame = std::get_if<sim::DeviceFrame>(&event.payload)) devices.insert(frame->device);
    EXPECT_GE(event.at_s, 0);
    EXPECT_LE(event.at_s, tape->seconds + 0.05);
  }
  EXPECT_EQ(lidars.size(), tape->site.global_lidars.size());
  EXPECT_EQ(devices.size(), tape->devices.size());
}

}  // namespace
}  // namespace liloc::soak
