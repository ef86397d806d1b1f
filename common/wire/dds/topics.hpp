#pragma once
// Private to common/wire: names of topics and partitions.
#include <string>

namespace liloc::wire {

inline constexpr const char* kRequestTopic = "liloc/spot_request";
inline constexpr const char* kReplyTopic = "liloc/spot_reply";
inline constexpr const char* kStatusTopic = "liloc/server_status";
inline constexpr const char* kStatusPartition = "liloc/status";
inline constexpr const char* kClientPrefix = "robots/";

inline std::string client_partition(const std::string& client_id) {
  return kClientPrefix + client_id;
}

/// ROS 2 puts rt/ before a topic's name.
inline std::string depth_topic(const std::string& id) {
  return "rt/" + id + "/depth/image_rect_raw";
}
inline std::string camera_info_topic(const std::string& id) {
  return "rt/" + id + "/depth/camera_info";
}
inline std::string points_topic(const std::string& id) {
  return "rt/" + id + "/points";
}
inline std::string imu_topic(const std::string& id) {
  return "rt/" + id + "/imu";
}
inline std::string pose_topic(const std::string& id) {
  return "rt/" + id + "/pose";
}
inline std::string odometry_topic(const std::string& id) {
  return "rt/" + id + "/odom";
}
inline constexpr const char* kTfTopic = "rt/tf";
inline constexpr const char* kDiagnosticsTopic = "rt/diagnostics";
inline std::string sensor_frame(const std::string& id) {
  return id + "/depth_optical_frame";
}
inline std::string odom_frame(const std::string& id) {
  return id + "/odom";
}

}  // namespace liloc::wire
