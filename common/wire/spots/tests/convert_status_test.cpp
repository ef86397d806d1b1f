#include "common/wire/spots/convert_status.hpp"

#include <gtest/gtest.h>

namespace liloc::wire {
namespace {

TEST(ConvertStatus, RoundTrip) {
  ServerStatus status;
  status.server_id = "edge1";
  status.lidars = {{"ceiling0", LidarState::slow, 2.5, 7, 3, std::string(300, 'e')}};
  status.codecs = {CloudCodec::voxel, CloudCodec::draco, static_cast<CloudCodec>(77)};
  auto sample = to_wire(status);
  const auto back = from_wire(sample.message);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->lidars[0].state, LidarState::slow);
  EXPECT_EQ(back->lidars[0].last_error.size(), 200U);
  EXPECT_EQ(back->codecs, status.codecs);
  sample.message.protocol_version = 99;
  const auto newer = from_wire(sample.message);
  ASSERT_FALSE(newer);
  EXPECT_NE(newer.error().message.find("version 99"), std::string::npos) << newer.error().message;
}

TEST(ConvertStatus, AStateOfANewerServerIsKeptAndCountsForNothing) {
  ServerStatus status;
  status.server_id = "edge1";
  status.lidars = {{"ceiling0"}, {"ceiling1", LidarState::ok}};
  auto sample = to_wire(status);
  for (const int state : {8, 9, 255}) {
    sample.lidars[0].state = static_cast<std::uint8_t>(state);
    const auto back = from_wire(sample.message);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(static_cast<int>(back->lidars[0].state), state);
    EXPECT_EQ(name_of(back->lidars[0].state), "unknown");
    EXPECT_FALSE(is_heard(back->lidars[0].state));
    EXPECT_EQ(back->lidars[1].state, LidarState::ok);
  }
}

}  // namespace
}  // namespace liloc::wire
