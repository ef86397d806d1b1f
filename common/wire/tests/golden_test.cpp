// The bytes of every message on the wire, as CDR: a change here breaks devices and ROS 2 in the field.
#include <dds/ddsi/ddsi_serdata.h>
#include <gtest/gtest.h>

#include <thread>

#include "common/wire/dds/convert.hpp"
#include "common/wire/dds/typed.hpp"
#include "common/wire/ros/convert_ros.hpp"
#include "common/wire/sensors/convert_sensors.hpp"
#include "common/wire/spots/convert_spot.hpp"
#include "common/wire/spots/convert_status.hpp"
#include "common/wire/spots/tests/samples.hpp"

namespace liloc::wire {
namespace {

// Two digits a byte; four or more zero bytes as their number in brackets.
std::string hex(const std::vector<unsigned char>& bytes) {
  std::string text;
  for (auto at = bytes.begin(); at != bytes.end();) {
    const auto zeros = std::find_if(at, bytes.end(), [](unsigned char byte) { return byte != 0; }) - at;
    if (zeros >= 4)
      text += fmt::format("({})", zeros);
    else
      text += fmt::format("{:02x}", *at);
    at += zeros >= 4 ? zeros : 1;
  }
  return text;
}

// Writes a sample through DDS and takes it as the bytes that travel, the four of the encapsulation first.
template <class T>
std::string cdr_of(const T& message) {
  const auto seat = Participant::create({.domain = 112}).value();
  const auto writer = make_writer<T>(seat.handle(), seat.handle(), "golden", reliable_qos(1)).value();
  const auto reader = make_reader<T>(seat.handle(), seat.handle(), "golden", reliable_qos(1)).value();
  EXPECT_EQ(dds_write(writer.handle(), &message), DDS_RETCODE_OK);
  ddsi_serdata* data = nullptr;
  dds_sample_info_t info;
  for (int i = 0; i < 500 && dds_takecdr(reader.handle(), &data, 1, &info, DDS_ANY_STATE) != 1; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  if (data == nullptr) return "nothing came";
  std::vector<unsigned char> bytes(ddsi_serdata_size(data));
  ddsi_serdata_to_ser(data, 0, bytes.size(), bytes.data());
  ddsi_serdata_unref(data);
  return hex(bytes);
}

TEST(Golden, SpotRequest) {
  const SpotRequest request = sample_request();
  EXPECT_EQ(cdr_of(to_wire(request, 0x1122334455667788).value().message),
            "000100010200000007000000726f626f74310000887766554433221107(7)15cd853dfe9c971703(13)f03f(7)40(6)f"
            "0bf(6)e03f(6)e0bf(6)e03f(6)e03f7b14ae47e17a843f7b14ae47e17a943f02(7)13cd853dfe9c9717(6)d03f(6)e0"
            "3f(6)d0bf(6)e03f(6)e0bf(6)e03f(6)e03f(8)15cd853dfe9c9717(6)e03f(6)f03f(6)e0bf(6)e03f(6)e0bf(6)e0"
            "3f(6)e03f010100000500000001020304050000009a9999999999a93f4001f0(10)906c40(5)d06c40(5)f06340(5)e0"
            "5d40fca9f1d24d62503f(6)d03f(6)214001(21)f0bf(8)7b14ae47e17a943f01(7)05cd853dfe9c971735cd853dfe9c"
            "97170300000009080700");
}

TEST(Golden, SpotReply) {
  EXPECT_EQ(cdr_of(to_wire(sample_reply(), 0x1122334455667788)),
            "000100030200000006000000656467653100000007000000726f626f7431(6)887766554433221107(7)15cd853dfe9c"
            "97171acd853dfe9c9717010100001200000074687265652073706f74732061677265650001(11)1040(6)2040(6)10c0"
            "(6)e03f(6)e0bf(6)e03f(6)e03f(6)d03f(38)c03f(14)d03f(54)d03f(54)d03f(54)d03f(54)d03f(6)e03f(6)a03"
            "f(6)e83f(6)d03f01(13)2040(6)3040(6)20c0(6)e03f(6)e0bf(6)e03f(6)e03f03(13)294035cd853dfe9c971745c"
            "d853dfe9c971755cd853dfe9c9717(6)e83f05000000");
}

TEST(Golden, ServerStatus) {
  EXPECT_EQ(
      cdr_of(to_wire(sample_status()).message),
      "000100020200000006000000656467653100000001(13)044001000000090000006365696c696e67300002(12)0c4004(7)05"
      "(7)0500000073746570(14)e03f(7)40(6)1040(6)d0bf010000000600000007(7)08(7)09(7)0a(7)0200000001030000");
}

TEST(Golden, RosImage) {
  const DepthImage image{5'000'000'001, 2, 2, {1, 2, 0x1234, 65535}};
  EXPECT_EQ(cdr_of(to_wire(image, "lidar")),
            "000100000500000001000000060000006c69646172000000020000000200000006000000313655433100000004000000"
            "08000000010002003412ffff");
}

TEST(Golden, RosCameraInfo) {
  EXPECT_EQ(cdr_of(to_wire(Camera{320, 240, 228.5, 230.5, 159.5, 119.5, 0.001}, 5'000'000'001, "lidar")),
            "000100030500000001000000060000006c69646172000000f0000000400100000a000000706c756d625f626f62(12)90"
            "6c40(13)f06340(13)d06c40(5)e05d40(22)f03f(6)f03f(30)f03f(30)f03f(5)906c40(13)f06340(21)d06c40(5)"
            "e05d40(30)f03f(36)");
}

TEST(Golden, RosPointCloud2) {
  const Cloud cloud{{{1, 2, 3}}, {}};
  EXPECT_EQ(cdr_of(to_wire(cloud, 5'000'000'001, "lidar").message),
            "000100030500000001000000060000006c696461720000000100000001000000030000000200000078(7)07000000010"
            "000000200000079000000040000000700000001000000020000007a000000080000000700000001(7)0c0000000c0000"
            "000c(5)803f000000400000404001000000");
}

TEST(Golden, RosImu) {
  EXPECT_EQ(cdr_of(to_wire(ImuSample{5'000'000'001, {0.5, -0.25, 0.125}, {0, 0, 9.75}}, "imu")),
            "00010000050000000100000004000000696d75(31)f03f(6)f0bf(70)e03f(6)d0bf(6)c03f(93)802340(72)");
}

TEST(Golden, RosPoseWithCovarianceStamped) {
  geometry_msgs_msg_dds__PoseWithCovarianceStamped_ m{};
  m.header = header_of(5'000'000'001, "map");
  m.pose.pose = {{1, 2, 3}, {0, 0, 0, 1}};
  m.pose.covariance[35] = 0.5;
  EXPECT_EQ(cdr_of(m), "000100000500000001000000040000006d6170(7)f03f(7)40(6)0840(30)f03f(286)e03f");
}

TEST(Golden, RosOdometry) {
  nav_msgs_msg_dds__Odometry_ m{};
  m.header = header_of(5'000'000'001, "odom");
  copy_text(m.child_frame_id, "lidar");
  m.pose.pose = {{1, 2, 3}, {0, 0, 0, 1}};
  m.twist.twist.linear.x = 0.5;
  EXPECT_EQ(cdr_of(m),
            "000100000500000001000000050000006f646f6d(4)060000006c69646172(9)f03f(7)40(6)0840(30)f03f(294)e03"
            "f(328)");
}

TEST(Golden, RosTf) {
  std::vector<geometry_msgs_msg_dds__TransformStamped_> transforms(1);
  transforms[0].header = header_of(5'000'000'001, "map");
  copy_text(transforms[0].child_frame_id, "odom");
  transforms[0].transform = {{1, 2, 3}, {0, 0, 0, 1}};
  tf2_msgs_msg_dds__TFMessage_ m{};
  lend(m.transforms, transforms);
  EXPECT_EQ(cdr_of(m),
            "00010000010000000500000001000000040000006d617000050000006f646f6d(10)f03f(7)40(6)0840(30)f03f");
}

TEST(Golden, RosDiagnosticArray) {
  const auto sample = diagnostics_message(
      5'000'000'001, "robot1", {Diagnosis::Level::warn, "liloc-client: robot1", "coasting", {{"frames", "7"}}});
  EXPECT_EQ(
      cdr_of(sample->message),
      "00010002050000000100000001(7)0100000001000000150000006c696c6f632d636c69656e743a20726f626f7431(4)090000"
      "00636f617374696e67(4)07000000726f626f7431000001000000070000006672616d657300000200000037000000");
}

}  // namespace
}  // namespace liloc::wire
