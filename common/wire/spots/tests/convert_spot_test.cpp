// Hostile and odd requests and replies: each is refused by the name of its field, or understood.
#include "common/wire/spots/convert_spot.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "common/wire/dds/convert.hpp"
#include "common/wire/spots/tests/samples.hpp"

namespace liloc::wire {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

template <class Message>
void expect_refused(const Message& message, std::string_view field) {
  const auto result = from_wire(message);
  ASSERT_FALSE(result) << field;
  EXPECT_NE(result.error().message.find(field), std::string::npos) << result.error().message;
}

struct RequestCase {
  const char* field;
  std::function<void(liloc_msg_SpotRequest&)> spoil;
};

TEST(ConvertRequest, HostileFieldsAreNamed) {
  const RequestCase cases[] = {
      {"client_id", [](auto& m) { copy_text(m.client_id, "../etc"); }},
      {"client_id", [](auto& m) { std::memset(m.client_id, 'a', sizeof m.client_id); }},
      {"stamp_ns", [](auto& m) { m.stamp_ns = -1; }},
      {"T_odom_sensor", [](auto& m) { m.T_odom_sensor.translation_m[1] = kNan; }},
      {"T_odom_sensor", [](auto& m) { m.T_odom_sensor.rotation_xyzw[0] = 2; }},
      {"odom_sd_rad", [](auto& m) { m.odom_sd_rad = -1; }},
      {"odom_sd_m", [](auto& m) { m.odom_sd_m = std::numeric_limits<double>::infinity(); }},
      {"local_poses", [](auto& m) { m.local_poses._buffer[0].T_odom_sensor.rotation_xyzw[3] = kNan; }},
      {"local_poses", [](auto& m) { m.local_poses._buffer[0].stamp_ns = m.stamp_ns + 1; }},
      {"codec", [](auto& m) { m.codec = 4; }},
      {"lpc", [](auto& m) { m.lpc._length = 0; }},
      {"voxel_size_m", [](auto& m) { m.voxel_size_m = 0; }},
      {"camera", [](auto& m) { m.camera.width = 0; }},
      {"camera", [](auto& m) { m.camera.fx = kNan; }},
      {"camera", [](auto& m) { m.camera.depth_scale_m = 0; }},
      {"min_range_m", [](auto& m) { m.min_range_m = kNan; }},
      {"max_range_m", [](auto& m) { m.max_range_m = 0.1; }},
      {"up_sensor", [](auto& m) { m.up_sensor[0] = 3; }},
      {"up_sd_rad", [](auto& m) { m.up_sd_rad = -0.1; }},
      {"ceiling_stamp_ns", [](auto& m) { m.ceiling_stamp_ns = -1; }},
      {"sent_ns", [](auto& m) { m.sent_ns = -1; }},
  };
  const SpotRequest request = sample_request();
  ASSERT_TRUE(from_wire(to_wire(request, 1)->message));
  for (const auto& [field, spoil] : cases) {
    auto sample = to_wire(request, 1).value();
    spoil(sample.message);
    expect_refused(sample.message, field);
  }
}

TEST(ConvertRequest, TheExtraCloudIsCarriedAndBounded) {
  SpotRequest request = sample_request();
  EXPECT_EQ(from_wire(to_wire(request, 1)->message)->extra.bytes, request.extra.bytes);
  request.extra.codec = CloudCodec::octree;
  EXPECT_FALSE(to_wire(request, 1));
  request.extra = {CloudCodec::draco, std::vector<std::uint8_t>(70'000, 1)};
  EXPECT_FALSE(to_wire(request, 1));
  request.extra.bytes.clear();
  EXPECT_TRUE(from_wire(to_wire(request, 1)->message)->extra.bytes.empty());
}

TEST(ConvertReply, HostileFieldsAreNamed) {
  const std::pair<const char*, std::function<void(liloc_msg_SpotReply&)>> cases[] = {
      {"status", [](auto& m) { m.status = 0; }},
      {"status", [](auto& m) { m.status = 4; }},
      {"covariance", [](auto& m) { m.covariance[7] = -1; }},
      {"covariance", [](auto& m) { m.covariance[35] = kNan; }},
      {"fitness", [](auto& m) { m.fitness = 1.5; }},
      {"overlap", [](auto& m) { m.overlap = kNan; }},
      {"inlier_rmse_m", [](auto& m) { m.inlier_rmse_m = -1; }},
      {"margin", [](auto& m) { m.margin = kNan; }},
      {"latency_ms", [](auto& m) { m.latency_ms = -5; }},
      {"confidence", [](auto& m) { m.confidence = 1.01; }},
      {"confidence", [](auto& m) { m.confidence = kNan; }},
      {"request_sent_ns", [](auto& m) { m.request_sent_ns = -1; }},
      {"server_received_ns", [](auto& m) { m.server_received_ns = -1; }},
      {"server_sent_ns", [](auto& m) { m.server_sent_ns = -1; }},
      {"T_map_sensor",
       [](auto& m) {
         m.T_map_sensor.rotation_xyzw[3] = 0;
         m.T_map_sensor.rotation_xyzw[0] = 0;
       }},
      {"T_map_odom", [](auto& m) { m.T_map_odom.translation_m[0] = 1e9; }},
  };
  for (const auto& [field, spoil] : cases) {
    auto message = to_wire(sample_reply(), 1);
    ASSERT_TRUE(from_wire(message));
    spoil(message);
    expect_refused(message, field);
  }
}

TEST(ConvertReply, ConfidenceAndAdviceAreCarried) {
  SpotReply reply = sample_reply();
  reply.confidence = 0.987;
  reply.advice = Advice::twin;
  auto message = to_wire(reply, 1);
  EXPECT_EQ(from_wire(message)->confidence, 0.987);
  EXPECT_EQ(from_wire(message)->advice, Advice::twin);
  message.advice = 200;
  EXPECT_EQ(name_of(from_wire(message)->advice), "unknown") << "a newer server may know more";
}

TEST(ConvertReply, AReasonOfANewerServerIsKept) {
  auto message = to_wire(sample_reply(), 1);
  message.reason = 200;
  const auto reply = from_wire(message);
  ASSERT_TRUE(reply);
  EXPECT_EQ(name_of(reply->reason), "unknown");
}

TEST(ConvertReply, LongTextIsCutAndTerminated) {
  SpotReply reply = sample_reply();
  reply.text.assign(500, 'x');
  const auto message = to_wire(reply, 1);
  EXPECT_EQ(message.text[200], '\0');
  EXPECT_EQ(from_wire(message)->text.size(), 200U);
}

}  // namespace
}  // namespace liloc::wire
