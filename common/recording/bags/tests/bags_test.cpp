// Bags that an independent writer made (write_bag.py), as recordings; and files that are none.
#include <gmock/gmock.h>

#include <cstdlib>

#include "common/recording/bags/bag.hpp"
#include "common/recording/bags/convert.hpp"
#include "common/recording/bags/tests/written.hpp"
#include "common/recording/files.hpp"
#include "common/recording/tests/temporary_folder.hpp"
#include "common/recording/writer.hpp"

namespace liloc::bags {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;
constexpr StampNs kStart_ns = 1'700'000'000'000'000'000;

fs::path bag_of_writer(const fs::path& folder, const std::string& kind) {
  const fs::path file = folder / (kind.starts_with("db3") ? "bag.db3" : "bag.mcap");
  const std::string command =
      std::string(LILOC_PYTHON) + " " + LILOC_BAG_WRITER + " " + file.string() + " " + kind;
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return file;
}

ConvertOptions all_sensors() {
  ConvertOptions options;
  options.lidars = {{"ceiling0", "/lidar0/depth/image"}, {"ceiling1", "/lidar1/depth/points"}};
  options.devices = {{"robot", "/camera/depth/image"}};
  options.imus = {{"robot", "/imu"}};
  return options;
}

class Bag : public testing::TestWithParam<const char*> {};

TEST_P(Bag, BecomesTheRecordingThatItHolds) {
  const TemporaryFolder folder;
  ConvertOptions options = all_sensors();
  options.truths = {{"robot", folder.put("truth.tum", "1700000000.1 1 2 3 0 0 0 1\n")}};
  const fs::path out = folder.path() / "rec";
  const auto converted = convert_bag(bag_of_writer(folder.path(), GetParam()), out, options);
  ASSERT_TRUE(converted) << converted.error().message;
  EXPECT_EQ(converted->messages.at("/camera/depth/image"), 3U);
  EXPECT_EQ(converted->messages.at("/imu"), 30U);
  const auto recording = open_recording(out);
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->lidars.size(), 2U);
  const GlobalLidar& lidar = recording->lidars[0].info;
  EXPECT_TRUE(lidar.T_map_sensor.translation().isApprox(Eigen::Vector3d(11, 2, 3)));
  EXPECT_TRUE((lidar.T_map_sensor.linear() * Eigen::Vector3d::UnitZ()).isApprox(-Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(lidar.camera.fy, 6.5);
  EXPECT_NEAR(lidar.rate_hz, 10, 1e-6);
  ASSERT_EQ(recording->lidars[0].depth.size(), 3U);
  const auto frame = read_depth(recording->lidars[0].depth[2], lidar.camera);
  ASSERT_TRUE(frame) << frame.error().message;
  EXPECT_EQ(frame->stamp_ns, kStart_ns + 200'000'000);
  EXPECT_EQ(frame->at(5, 4), 2007);
  const auto rendered = read_depth(recording->lidars[1].depth[0], recording->lidars[1].info.camera);
  ASSERT_TRUE(rendered);
  EXPECT_EQ(std::ranges::count_if(rendered->units, [](auto z) { return z != 0; }), 2)
      << "and one is not a number";
  EXPECT_EQ(std::ranges::max(rendered->units), 2500);

  ASSERT_EQ(recording->devices.size(), 1U);
  const DeviceRecording& device = recording->devices[0];
  const auto depth = read_depth(device.depth[0], device.info.camera);
  ASSERT_TRUE(depth);
  EXPECT_EQ(depth->at(7, 5), 1500);
  ASSERT_EQ(device.imu.size(), 30U);
  EXPECT_EQ(device.imu[11].stamp_ns, kStart_ns + 110'000'000);
  EXPECT_EQ(device.imu[11].angular_velocity_rad_s, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(device.imu[11].specific_force_m_s2, Eigen::Vector3d(0.5, -0.5, 9.75));
  ASSERT_TRUE(device.info.T_imu_sensor);
  EXPECT_TRUE((*device.info.T_imu_sensor * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(0.1, 1, 0)));
  EXPECT_EQ(read_ground_truth(device)->size(), 1U);
}
INSTANTIATE_TEST_SUITE_P(Kinds, Bag,
                         testing::Values("db3", "db3-big", "mcap", "mcap-zstd", "mcap-lz4", "mcap-zstd-big"));

/// independent.mcap is by Foxglove's writers (write_fixture.mjs): zstd chunks, attachment, metadata, index,
/// summary.
TEST(BagFiles, OneOfAnIndependentWriterIsRead) {
  const TemporaryFolder folder;
  ConvertOptions options = all_sensors();
  options.lidars.erase("ceiling1");
  const auto converted = convert_bag(LILOC_INDEPENDENT_BAG, folder.path() / "rec", options);
  ASSERT_TRUE(converted) << converted.error().message;
  const auto recording = open_recording(folder.path() / "rec");
  ASSERT_TRUE(recording) << recording.error().message;
  const LidarRecording& lidar = recording->lidars.at(0);
  EXPECT_TRUE(lidar.info.T_map_sensor.translation().isApprox(Eigen::Vector3d(11, 2, 3)));
  ASSERT_EQ(lidar.depth.size(), 3U);
  EXPECT_EQ(read_depth(lidar.depth[2], lidar.info.camera)->at(5, 4), 2002);
  const DeviceRecording& device = recording->devices.at(0);
  EXPECT_EQ(device.depth.size(), 3U);
  EXPECT_EQ(device.info.camera.fy, 6.5);
  EXPECT_TRUE(device.info.T_imu_sensor->translation().isApprox(Eigen::Vector3d(0.1, 0, 0)));
  ASSERT_EQ(device.imu.size(), 15U);
  EXPECT_EQ(device.imu[7].stamp_ns, kStart_ns + 140'000'000);
  EXPECT_EQ(device.imu[7].specific_force_m_s2, Eigen::Vector3d(0.5, -0.5, 9.75));
}

TEST(BagFiles, AStopLeavesNothing) {
  const TemporaryFolder folder;
  ConvertOptions options = all_sensors();
  options.lidars.erase("ceiling1");
  int asked = 0;
  options.stopped = [&] { return ++asked > 40; };  // of 28 messages: while the frames are written
  const auto converted = convert_bag(LILOC_INDEPENDENT_BAG, folder.path() / "rec", options);
  ASSERT_FALSE(converted);
  EXPECT_THAT(converted.error().message, HasSubstr("stopped by a signal"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(BagFiles, AFolderOfThemIsABagToo) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "bag");
  bag_of_writer(folder.path() / "bag", "mcap-lz4");
  folder.put("bag/metadata.yaml", "rosbag2_bagfile_information:");
  EXPECT_TRUE(is_bag(folder.path() / "bag"));
  EXPECT_FALSE(is_bag(folder.path()));
  EXPECT_TRUE(convert_bag(folder.path() / "bag", folder.path() / "rec/", all_sensors()));
  EXPECT_FALSE(is_bag(folder.path() / "rec"));
}

class Trouble : public testing::Test {
 protected:
  std::string message(const fs::path& bag, const ConvertOptions& options = all_sensors()) {
    const auto converted = convert_bag(bag, folder_.path() / "rec", options);
    EXPECT_FALSE(fs::exists(folder_.path() / "rec")) << "nothing half-written";
    EXPECT_FALSE(fs::exists(folder_.path() / ".rec.part"));
    return converted ? "converted" : converted.error().message;
  }
  const TemporaryFolder folder_;
};

TEST_F(Trouble, TruncatedAtAnyByteIsOneClearError) {
  for (const char* kind : {"mcap", "mcap-zstd", "mcap-lz4", "db3"}) {
    const fs::path file = bag_of_writer(folder_.path(), kind);
    const std::string bytes = *read_file(file, 1 << 24);
    for (const std::size_t part : {1U, 3U, 6U, 9U}) {
      ASSERT_TRUE(write_file(file, bytes.substr(0, bytes.size() * part / 10)));
      EXPECT_THAT(message(file), testing::AnyOf(HasSubstr("ends in the middle"), HasSubstr("no sound rosbag2")))
          << kind << " " << part;
    }
    fs::remove(file);
  }
}

TEST_F(Trouble, ADamagedChunkIsOneClearError) {
  for (const std::string how : {"", "zstd", "lz4"}) {
    const fs::path file = bag_of_writer(folder_.path(), how.empty() ? "mcap" : "mcap-" + how);
    std::string bytes = *read_file(file, 1 << 24);
    // Behind the compression's name and a length of 8 bytes; a chunk's times before it are under no checksum.
    const std::size_t at = how.empty() ? bytes.size() / 2 : bytes.find(how) + how.size() + 8 + 40;
    for (std::size_t k = at; k < at + 8; ++k) bytes[k] = static_cast<char>(bytes[k] ^ 0x55);
    ASSERT_TRUE(write_file(file, bytes));
    EXPECT_THAT(message(file), testing::AllOf(HasSubstr("bag.mcap: "), HasSubstr("chunk"))) << how;
  }
}

TEST_F(Trouble, ForeignFilesAreNamed) {
  EXPECT_THAT(message(folder_.path() / "absent.mcap"), HasSubstr("no such file"));
  EXPECT_THAT(message(folder_.put("a.mcap", "something else")), HasSubstr("no MCAP file"));
  EXPECT_THAT(message(folder_.put("a.db3", "something else")), HasSubstr("no sound rosbag2 database"));
  EXPECT_THAT(message(folder_.put("a.db3", "")), HasSubstr("no sound rosbag2 database"));
  EXPECT_THAT(message(folder_.put("a.bag", "#ROSBAG V2.0")), HasSubstr("is no bag"));
}

TEST_F(Trouble, TopicsThatDoNotFitAreNamedWithThoseThatWould) {
  const fs::path bag = bag_of_writer(folder_.path(), "mcap");
  ConvertOptions options = all_sensors();
  options.devices["robot"] = "/camera/colour";
  EXPECT_THAT(message(bag, options), HasSubstr("/camera/depth/image, /lidar0/depth/image"));
  options.devices["robot"] = "/imu";
  EXPECT_THAT(message(bag, options), HasSubstr("given twice"));
  options = all_sensors();
  options.imus["robot"] = "/chatter";
  EXPECT_THAT(message(bag, options), HasSubstr("chatter"));
  options = all_sensors();
  options.world_frame = "moon";
  EXPECT_THAT(message(bag, options), HasSubstr("to moon; give --site or --world"));
  options = all_sensors();
  options.imus["nobody"] = "/imu2";
  EXPECT_THAT(message(bag, options), HasSubstr("--device nobody"));
  EXPECT_THAT(message(bag, {}), HasSubstr("--lidar"));
  options = all_sensors();
  options.world_frame = "the map";
  EXPECT_THAT(message(bag, options), HasSubstr("--world"));
  options = all_sensors();
  options.devices["a-1"] = "/a";
  options.devices["a_1"] = "/b";
  EXPECT_THAT(message(bag, options), HasSubstr("a-1 and a_1 are one in the names of topics"));
}

TEST_F(Trouble, ABagWithoutDepthSaysSo) {
  const std::string chatter = written::channel("/chatter", "std_msgs/msg/String") + written::message("hello");
  EXPECT_THAT(message(folder_.put("talk.mcap", written::mcap(chatter))),
              HasSubstr("has no topic /lidar0/depth/image; it has none of that kind"));
}

TEST(BagFiles, FilesTellWhatTheBagDoesNot) {
  const TemporaryFolder folder;
  ConvertOptions options = all_sensors();
  const Camera camera{8, 6, 7, 7, 3.5, 2.5, 0.0005};
  options.site_file = folder.path() / "site.json";
  ASSERT_TRUE(write_site(
      options.site_file,
      {"hall", {{"ceiling0", camera, 5, Pose::Identity()}, {"ceiling1", camera, 5, Pose::Identity()}}}));
  options.device_files = {{"robot", folder.path() / "device.json"}};
  ASSERT_TRUE(write_device(options.device_files.at("robot"), {"other", camera, 1, 9, {}, Pose::Identity()}));
  const auto converted = convert_bag(bag_of_writer(folder.path(), "mcap"), folder.path() / "rec", options);
  ASSERT_TRUE(converted) << converted.error().message;
  const auto recording = open_recording(folder.path() / "rec");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->site.world_frame, "hall");
  const auto ceiling = read_depth(recording->lidars[0].depth[0], camera);
  EXPECT_EQ(ceiling->at(0, 0), 2000) << "integers are units of the sensor, as they are when it streams";
  const DeviceRecording& device = recording->devices[0];
  EXPECT_EQ(device.info.id, "robot");
  EXPECT_EQ(device.info.camera.depth_scale_m, 0.0005);
  EXPECT_EQ(device.info.still_seconds, 9);
  EXPECT_NEAR(device.info.rate_hz, 10, 1e-6);
  EXPECT_TRUE(device.info.T_imu_sensor->isApprox(Pose::Identity()));
  EXPECT_EQ(read_depth(device.depth[0], camera)->at(0, 0), 3000) << "1.5 m";
}

/// A LiDAR with a good image and what else is asked for; its intrinsics and place come from the bag.
std::string records_with(const std::string& more, bool good = true) {
  const std::string info = written::camera_info(8, 4, {8, 0, 3.5, 0, 8, 1.5, 0, 0, 1});
  const std::string image = written::image("16UC1", 8, 4, std::string(64, '\1'), kStart_ns);
  written::Cdr tf;
  tf.put(std::uint32_t{1}).header("map").text("camera");
  for (const double v : {0.0, 0.0, 3.0, 1.0, 0.0, 0.0, 0.0}) tf.put(v);
  return written::channel("/l/image", "sensor_msgs/msg/Image", 1) +
         written::channel("/l/camera_info", "sensor_msgs/msg/CameraInfo", 2) +
         written::channel("/tf", "tf2_msgs/msg/TFMessage", 3) + more +
         (good ? written::message(info, 2) + written::message(tf.done(), 3) + written::message(image, 1) : "");
}

TEST_F(Trouble, MessagesThatCannotBeUsedAreCountedByTopicAndLeftOut) {
  const std::string spoiled = written::message("?", 1) + written::message("?", 2) + written::message("?", 3) +
                              written::message(written::image("rgb8", 2, 1, "abcd"), 1) +
                              written::message(written::image("16UC1", 2, 1, "abcd"), 1);
  ConvertOptions options;
  options.lidars = {{"ceiling0", "/l/image"}};
  const fs::path bag = folder_.put("bag.mcap", written::mcap(records_with(spoiled)));
  const auto converted = convert_bag(bag, folder_.path() / "good", options);
  ASSERT_TRUE(converted) << converted.error().message;
  EXPECT_EQ(converted->messages.at("/l/image"), 1U);
  EXPECT_EQ(converted->left_out.at("/l/image").messages, 3U);
  EXPECT_THAT(converted->left_out.at("/l/image").first, HasSubstr("cut short"));
  EXPECT_EQ(converted->left_out.at("/l/camera_info").messages, 1U);
  EXPECT_EQ(converted->left_out.at("/tf").messages, 1U);
  EXPECT_TRUE(open_recording(folder_.path() / "good"));
}

TEST_F(Trouble, WhereNoMessageCanBeUsedTheFirstSaysWhy) {
  ConvertOptions options;
  options.lidars = {{"ceiling0", "/l/image"}};
  const auto said = [&](const std::string& records) {
    return message(folder_.put("bag.mcap", written::mcap(records)), options);
  };
  EXPECT_THAT(said(records_with(written::message("?", 1), false)),
              HasSubstr("/l/image: none of its messages can be used; the first is no such message"));
  const std::string image = written::message(written::image("16UC1", 8, 4, std::string(64, '\1')), 1);
  EXPECT_THAT(said(records_with(image + written::message("?", 2), false)),
              HasSubstr("/l/camera_info: none of its messages can be used; the first is no such message"));
  const std::string small = written::message(written::image("16UC1", 2, 1, "abcd"), 4);
  options.lidars = {{"ceiling0", "/l/small"}};
  EXPECT_THAT(
      said(written::channel("/l/small", "sensor_msgs/msg/Image", 4) + records_with(small + small)),
      HasSubstr("/l/small: none of its messages can be used; the first is 2x1, the intrinsics are for 8x4"));
}

TEST_F(Trouble, WhatStandsInTheWayIsLeftAlone) {
  folder_.put("rec2/thesis.txt", "years of work");
  const auto converted =
      convert_bag(bag_of_writer(folder_.path(), "mcap"), folder_.path() / "rec2", all_sensors());
  ASSERT_FALSE(converted);
  EXPECT_THAT(converted.error().message, HasSubstr("is there already"));
  EXPECT_TRUE(fs::exists(folder_.path() / "rec2/thesis.txt"));
}

}  // namespace
}  // namespace liloc::bags
