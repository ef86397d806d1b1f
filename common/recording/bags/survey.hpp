#pragma once
// Private to the room: what a bag says of its sensors, before any frame is written.
#include <map>
#include <string>
#include <vector>

#include "common/recording/bags/bag.hpp"
#include "common/recording/bags/convert.hpp"
#include "common/recording/bags/frames.hpp"
#include "common/recording/bags/ros_messages.hpp"

namespace liloc::bags {

constexpr std::string_view kImage = "sensor_msgs/msg/Image", kPoints = "sensor_msgs/msg/PointCloud2",
                           kImu = "sensor_msgs/msg/Imu", kCameraInfo = "sensor_msgs/msg/CameraInfo";

struct TopicSurvey {
  std::string type, frame_id;
  std::size_t messages = 0;  ///< with a header that can be read; of those in `wanted`
  StampNs first_ns = 0, last_ns = 0;

  /// Messages a second, 0.1 to 1000.
  [[nodiscard]] double rate_hz() const;
};
struct Survey {
  std::map<std::string, TopicSurvey, std::less<>> topics;  ///< by name, all of the bag
  std::map<std::string, Camera, std::less<>> cameras;      ///< by topic of the CameraInfo
  Frames frames;
  LeftOutByTopic left_out;  ///< of all that is read here
};

/// "TOPIC: none of its messages can be used; the first ...", where one was tried.
[[nodiscard]] std::string none_of(const std::string& topic, const LeftOutByTopic& left_out);

/// Reads the whole bag. Frames' stamps are those of the topics in `wanted`. Error: also when `stopped`, asked
/// at each message, says so.
[[nodiscard]] Result<Survey> survey_bag(const std::filesystem::path& bag,
                                        const std::vector<std::string>& wanted,
                                        const std::function<bool()>& stopped = {});

/// The intrinsics of the images on a topic.
[[nodiscard]] Result<Camera> camera_of(const Survey& survey, const std::string& topic);

}  // namespace liloc::bags
