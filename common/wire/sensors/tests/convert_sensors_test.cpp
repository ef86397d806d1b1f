// Hostile and odd sensor messages: each is refused by the name of its field, or understood.
#include "common/wire/sensors/convert_sensors.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <functional>
#include <limits>

#include "common/wire/dds/convert.hpp"

namespace liloc::wire {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

template <class Message>
void expect_refused(const Message& message, std::string_view field) {
  const auto result = from_wire(message);
  ASSERT_FALSE(result) << field;
  EXPECT_NE(result.error().message.find(field), std::string::npos) << result.error().message;
}

DepthImage depth_2x2() {
  return {5'000'000'001, 2, 2, {1, 2, 0x1234, 65534}};
}

Result<DepthImage> read(const sensor_msgs_msg_dds__Image_& message) {
  return from_wire(message, 0.001);
}

TEST(ConvertImage, RoundTripKeepsUnitsAndStamp) {
  const DepthImage image = depth_2x2();
  const auto back = read(to_wire(image, "lidar"));
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->units, image.units);
  EXPECT_EQ(back->stamp_ns, image.stamp_ns);
}

TEST(ConvertImage, BigEndianAndPaddedRowsAreUnderstood) {
  const std::vector<std::uint8_t> bytes = {0x12, 0x34, 0x00, 0x01, 9, 9, 0xff, 0xff, 0x00, 0x02, 9, 9};
  const DepthImage original = depth_2x2();
  auto message = to_wire(original, "lidar");
  message.is_bigendian = 1;
  message.step = 6;
  lend(message.data, bytes);
  const auto image = read(message);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->units, (std::vector<std::uint16_t>{0x1234, 1, 0, 2})) << "the largest value is no return";
}

TEST(ConvertImage, MetresBecomeUnitsAndNoReturnStaysZero) {
  const std::vector<float> metres = {1.5F, 0.0F, std::numeric_limits<float>::quiet_NaN(), 100.0F};
  std::vector<std::uint8_t> bytes(16);
  std::memcpy(bytes.data(), metres.data(), 16);
  const DepthImage original = depth_2x2();
  auto message = to_wire(original, "lidar");
  copy_text(message.encoding, "32FC1");
  message.step = 8;
  lend(message.data, bytes);
  const auto image = from_wire(message, 0.00025);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->units, (std::vector<std::uint16_t>{6000, 0, 0, 0}));
}

TEST(ConvertImage, HostileFieldsAreNamed) {
  const std::pair<const char*, std::function<void(sensor_msgs_msg_dds__Image_&)>> cases[] = {
      {"encoding", [](auto& m) { copy_text(m.encoding, "rgb8"); }},
      {"0 x 2", [](auto& m) { m.width = 0; }},
      {"x 4000000000", [](auto& m) { m.height = 4'000'000'000; }},
      {"step", [](auto& m) { m.step = 3; }},
      {"data", [](auto& m) { m.data._length -= 1; }},
      {"data", [](auto& m) { m.step = 2'000'000'000; }},
      {"stamp", [](auto& m) { m.header.stamp.nanosec = 4'000'000'000; }},
      {"stamp", [](auto& m) { m.header.stamp.sec = -5; }},
  };
  const DepthImage image = depth_2x2();
  for (const auto& [field, spoil] : cases) {
    auto message = to_wire(image, "lidar");
    spoil(message);
    const auto result = read(message);
    ASSERT_FALSE(result) << field;
    EXPECT_NE(result.error().message.find(field), std::string::npos) << result.error().message;
  }
}

TEST(ConvertCameraInfo, RoundTripAndHostileFields) {
  const Camera camera{320, 240, 228.5, 230.5, 159.5, 119.5, 0.001};
  const auto message = to_wire(camera, 7, "lidar");
  const auto back = from_wire(message);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->width, 320);
  EXPECT_EQ(back->fy, 230.5);
  EXPECT_EQ(back->cx, 159.5);
  auto zero = message;
  zero.k[0] = 0;
  EXPECT_TRUE(from_wire(zero)) << "p counts where it is set";
  zero.p[0] = 0;
  expect_refused(zero, "camera_info");
  auto skewed = message;
  std::ranges::fill(skewed.p, 0);
  skewed.k[1] = 1;
  expect_refused(skewed, "k is not");
  auto wide = message;
  wide.width = 100'000;
  expect_refused(wide, "100000 x 240");
}

TEST(ConvertCameraInfo, TheRectifiedImagesIntrinsicsCountWhereTheyAreSet) {
  auto message = to_wire(Camera{320, 240, 228.5, 230.5, 159.5, 119.5, 0.001}, 7, "lidar");
  message.p[0] = 200;
  message.p[2] = 150;
  message.p[3] = -10;  // a baseline says nothing of the image
  message.k[1] = 1;    // of the raw image
  const auto rectified = from_wire(message);
  ASSERT_TRUE(rectified) << rectified.error().message;
  EXPECT_EQ(rectified->fx, 200);
  EXPECT_EQ(rectified->cx, 150);
  message.k[1] = 0;
  std::ranges::fill(message.p, 0);
  EXPECT_EQ(from_wire(message)->fx, 228.5);
  EXPECT_FALSE(distorted(message));
  std::array<double, 5> d{0, 0.1, 0, 0, 0};
  message.d._buffer = d.data();
  message.d._length = 5;
  EXPECT_TRUE(distorted(message));
  message.d._buffer = nullptr;
  message.d._length = 0;
}

TEST(ConvertCameraInfo, RoiAndBinningApply) {
  auto message = to_wire(Camera{640, 480, 460, 462, 320, 240, 0.001}, 7, "lidar");
  message.binning_x = message.binning_y = 2;
  const auto binned = from_wire(message);
  ASSERT_TRUE(binned) << binned.error().message;
  EXPECT_EQ(binned->width, 320);
  EXPECT_EQ(binned->height, 240);
  EXPECT_EQ(binned->fx, 230);
  EXPECT_EQ(binned->cy, 120);
  message.roi = {100, 40, 400, 440, true};  // x, y, height, width
  const auto part = from_wire(message);
  ASSERT_TRUE(part) << part.error().message;
  EXPECT_EQ(part->width, 220);
  EXPECT_EQ(part->height, 200);
  EXPECT_EQ(part->cx, 110);
  EXPECT_EQ(part->cy, 100);
  message.roi.width = 0xFFFFFFFF;
  expect_refused(message, "roi");
  message.roi = {};
  message.binning_x = 1000;
  expect_refused(message, "binning");
}

TEST(ConvertPoints, FieldsAtAnyOffsetInAnyByteOrder) {
  std::vector<std::uint8_t> bytes(2 * 20, 0xAA);  // z at 2, x at 6, y at 14, in points of 20 bytes
  const auto put = [&](std::size_t at, float value, bool big) {
    auto raw = std::bit_cast<std::array<std::uint8_t, 4>>(value);
    if (big) std::ranges::reverse(raw);
    std::ranges::copy(raw, bytes.begin() + static_cast<std::ptrdiff_t>(at));
  };
  for (const bool big : {false, true}) {
    for (std::size_t i = 0; i < 2; ++i) {
      put(20 * i + 6, 1.0F + static_cast<float>(i), big);
      put(20 * i + 14, 2.0F, big);
      put(20 * i + 2, 3.0F, big);
    }
    const Cloud cloud_of_two{{{0, 0, 0}, {0, 0, 0}}, {}};
    auto sample = to_wire(cloud_of_two, 9, "lidar");
    sample.fields[0].offset = 6;
    sample.fields[1].offset = 14;
    sample.fields[2].offset = 2;
    sample.message.is_bigendian = big;
    sample.message.point_step = 20;
    sample.message.row_step = 40;
    lend(sample.message.data, bytes);
    const auto cloud = from_wire(sample.message);
    ASSERT_TRUE(cloud) << cloud.error().message;
    ASSERT_EQ(cloud->cloud_sensor.size(), 2U);
    EXPECT_EQ(cloud->cloud_sensor.points[1], Eigen::Vector3f(2, 2, 3));
    EXPECT_EQ(cloud->stamp_ns, 9);
  }
}

TEST(ConvertPoints, HostileFieldsAreNamed) {
  const std::pair<const char*, std::function<void(PointsSample&)>> cases[] = {
      {"lack z", [](auto& s) { copy_text(s.fields[2].name, "w"); }},
      {"datatype", [](auto& s) { s.fields[0].datatype = 8; }},
      {"offset", [](auto& s) { s.fields[1].offset = 0xffffffff; }},
      {"offset", [](auto& s) { s.message.point_step = 0; }},
      {"row_step", [](auto& s) { s.message.row_step = 4; }},
      {"data", [](auto& s) { s.message.data._length = 3; }},
      {"points", [](auto& s) { s.message.width = s.message.height = 0xffffffff; }},
      {"points",
       [](auto& s) {
         s.message.width = s.message.row_step = s.message.data._length = 0;
         s.message.height = 0xffffffff;
       }},
  };
  const Cloud cloud{{{1, 2, 3}, {4, 5, 6}}, {}};
  for (const auto& [field, spoil] : cases) {
    auto sample = to_wire(cloud, 9, "lidar");
    spoil(sample);
    expect_refused(sample.message, field);
  }
}

TEST(ConvertImu, RoundTripAndHostileFields) {
  const ImuSample sample{1'500'000'000, {0.1, -0.2, 0.3}, {0, 0, 9.8}};
  const auto message = to_wire(sample, "imu");
  const auto back = from_wire(message);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->stamp_ns, sample.stamp_ns);
  EXPECT_EQ(back->angular_velocity_rad_s, sample.angular_velocity_rad_s);
  EXPECT_EQ(back->specific_force_m_s2, sample.specific_force_m_s2);
  auto in_degrees = message;
  in_degrees.angular_velocity.x = 300;
  in_degrees.linear_acceleration.z = 9810;
  EXPECT_TRUE(from_wire(in_degrees)) << "who knows the motion names the unit, and counts what is wild";
  auto spun = message;
  spun.angular_velocity.y = kNan;
  expect_refused(spun, "angular_velocity");
  auto hit = message;
  hit.linear_acceleration.z = 1e9;
  expect_refused(hit, "linear_acceleration");
}

}  // namespace
}  // namespace liloc::wire
