#include "proto-tests/replay/streams.hpp"

#include <gmock/gmock.h>

namespace liloc::replay {
namespace {

constexpr Camera kCamera{64, 48, 50, 50, 32, 24, 0.001};

TEST(Streams, SensorsWhoseTopicsAreOneAreRefused) {
  const auto participant = wire::Participant::create({.domain = 138});  // of this test alone
  ASSERT_TRUE(participant) << participant.error().message;
  const Site site{"map", {{"ceiling-0", kCamera, 10, Pose::Identity()}}};
  const auto device = [](const char* id) {
    DeviceInfo info;
    info.id = id;
    info.camera = kCamera;
    return info;
  };
  EXPECT_TRUE(Streams::create(*participant, site, {device("robot-1"), device("robot-2")}));
  const auto alike = Streams::create(*participant, site, {device("robot-1"), device("robot_1")});
  ASSERT_FALSE(alike);
  EXPECT_THAT(alike.error().message, testing::HasSubstr("robot-1 and robot_1"));
  EXPECT_FALSE(Streams::create(*participant, site, {device("ceiling_0")}));
}

}  // namespace
}  // namespace liloc::replay
