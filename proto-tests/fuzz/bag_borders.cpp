// ROS 2 bags: the files, and the messages in them.
#include <sqlite3.h>

#include <filesystem>
#include <utility>

#include "common/recording/bags/bag.hpp"
#include "common/recording/bags/ros_messages.hpp"
#include "common/recording/bags/tests/written.hpp"
#include "common/recording/files.hpp"
#include "proto-tests/fuzz/border.hpp"

namespace liloc::fuzz {
namespace {

namespace fs = std::filesystem;
using bags::written::Cdr;

template <class T>
Status status_of(const Result<T>& result) {
  return result ? Status() : tl::unexpected(result.error());
}

std::string cloud_seed() {
  Cdr out;
  out.header("lidar").put(std::uint32_t{1}).put(std::uint32_t{2}).put(std::uint32_t{3});
  std::uint32_t at = 0;
  for (const char* axis : {"x", "y", "z"})
    out.text(axis).put(std::exchange(at, at + 4)).put(std::uint8_t{7}).put(std::uint32_t{1});
  out.put(std::uint8_t{0}).put(std::uint32_t{12}).put(std::uint32_t{24}).blob(std::string(24, '\x3f'));
  return out.put(std::uint8_t{1}).done();
}

std::string transform_seed() {
  Cdr out;
  out.put(std::uint32_t{1}).header("map").text("lidar");
  for (const double v : {1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0}) out.put(v);
  return out.done();
}

std::string records() {
  return bags::written::channel("/depth/image", "sensor_msgs/msg/Image") +
         bags::written::message(bags::written::image("16UC1", 2, 1, "abcd"));
}

std::string mcap_in_chunk() {
  return bags::written::mcap(bags::written::chunk("", records(), records().size()));
}

std::string database() {
  const std::string file = scratch_file("seed.db3", "");
  fs::remove(file);
  sqlite3* made = nullptr;
  const bool fine =
      sqlite3_open(file.c_str(), &made) == SQLITE_OK &&
      sqlite3_exec(made,
                   "PRAGMA page_size = 512;"
                   "CREATE TABLE topics(id INTEGER PRIMARY KEY, name, type, serialization_format);"
                   "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, data);"
                   "INSERT INTO topics VALUES(1, '/a', 'std_msgs/msg/String', 'cdr');"
                   "INSERT INTO messages VALUES(1, 1, 5, x'0001000002000000');",
                   nullptr, nullptr, nullptr) == SQLITE_OK;
  sqlite3_close(made);
  require(fine, "a seed cannot be written");
  return read_file(file, 1 << 20).value();
}

Status read_as(const std::string& name, const std::string& bytes) {
  return bags::read_bag(scratch_file(name, bytes), [](const bags::Message& message) {
    return message.topic.size() <= 1024 ? Status() : fail("the topic is too long");
  });
}

Status read_image(const std::string& bytes) {
  const auto image = bags::depth_image(bytes, 0.001);
  if (!image) return status_of(image);
  require(image->value.units.size() == static_cast<std::size_t>(image->value.width * image->value.height),
          "the image has another size");
  return {};
}

}  // namespace

std::vector<Border> bag_borders() {
  return {
      {.name = "mcap",
       .seeds = {bags::written::mcap(records()), mcap_in_chunk()},
       .read = [](const auto& bytes) { return read_as("bag.mcap", bytes); }},
      {.name = "rosbag2",
       .seeds = {database()},
       .read = [](const auto& bytes) { return read_as("bag.db3", bytes); }},
      {.name = "bag-image",
       .seeds = {bags::written::image("16UC1", 2, 1, "abcd"), bags::written::image("32FC1", 1, 1, "abcd")},
       .read = read_image},
      {.name = "bag-camera-info",
       .seeds = {bags::written::camera_info(2, 1, {2, 0, 0.5, 0, 2, 0.5, 0, 0, 1}),
                 bags::written::camera_info(8, 4, {8, 0, 4, 0, 8, 2, 0, 0, 1},
                                            {8, 0, 4, 0, 0, 8, 2, 0, 0, 0, 1, 0}, 2, {2, 0, 4, 4})},
       .read = [](const auto& bytes) { return status_of(bags::camera_info(bytes)); }},
      {.name = "bag-imu",
       .seeds = {bags::written::imu({0.1, 0.2, 0.3}, {0.5, -0.5, 9.75})},
       .read = [](const auto& bytes) { return status_of(bags::imu(bytes)); }},
      {.name = "bag-points",
       .seeds = {cloud_seed()},
       .read = [](const auto& bytes) { return status_of(bags::point_cloud(bytes)); }},
      {.name = "bag-transforms",
       .seeds = {transform_seed()},
       .read = [](const auto& bytes) { return status_of(bags::transforms(bytes)); }},
  };
}

}  // namespace liloc::fuzz
