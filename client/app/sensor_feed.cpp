#include "client/app/sensor_feed.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "common/base/limited_log.hpp"

namespace liloc {
Status SensorFeed::subscribe_frames(wire::Dispatcher& sensors) {
  const SensorTopics& topics = options_.topics;
  if (topics.use_points)
    return wire::subscribe_points_at(sensors, topics.points,
                                     [this](const Result<wire::StampedCloud>& cloud) { take_points(cloud); });
  if (auto ok = wire::subscribe_depth_at(sensors, topics.depth, options_.client.camera.depth_scale_m,
                                         [this](const Result<DepthImage>& image) { take_depth(image); });
      !ok)
    return ok;
  return wire::subscribe_camera_info_at(sensors, topics.camera_info,
                                        [this](const Result<Camera>& camera) { take_camera_info(camera); });
}

Status SensorFeed::subscribe(wire::Dispatcher& sensors) {
  const SensorTopics& topics = options_.topics;
  if (auto ok = subscribe_frames(sensors); !ok) return ok;
  if (options_.client.T_imu_sensor)
    if (auto ok = wire::subscribe_imu_at(sensors, topics.imu,
                                         [this](const Result<ImuSample>& sample) { take_imu(sample); });
        !ok)
      return ok;
  if (topics.odometry.empty()) return {};
  return wire::subscribe_odometry_at(
      sensors, topics.odometry,
      [this](const Result<wire::StampedOdometry>& odometry) { take_odometry(odometry); });
}

void SensorFeed::complain(const std::string& what) {
  if (const auto held = complaints_.pass(std::chrono::steady_clock::now()))
    log::warning("{}{}", what, held_back(*held));
}

void SensorFeed::take_depth(const Result<DepthImage>& image) {
  if (!image) return client_.push_unusable(image.error().message);
  // What is refused the client counts and tells.
  static_cast<void>(client_.push_depth(image->units.data(), image->width, image->height, image->stamp_ns));
}

void SensorFeed::take_imu(const Result<ImuSample>& sample) {
  if (!sample) return complain(sample.error().message);
  const Eigen::Vector3d &w = sample->angular_velocity_rad_s, &f = sample->specific_force_m_s2;
  const auto taken = client_.push_imu(sample->stamp_ns, {w.x(), w.y(), w.z()}, {f.x(), f.y(), f.z()});
  if (!taken) complain(taken.error());
}

void SensorFeed::take_points(const Result<wire::StampedCloud>& cloud) {
  if (!cloud) return client_.push_unusable(cloud.error().message);
  const auto& points = cloud->cloud_sensor.points;
  if (points.empty()) return client_.push_unusable("a cloud without a finite point");
  static_cast<void>(client_.push_points(points.front().data(), points.size(), cloud->stamp_ns));
}

void SensorFeed::take_odometry(const Result<wire::StampedOdometry>& odometry) {
  if (!odometry) return complain(odometry.error().message);
  const std::string& expected = options_.ros.names.odom_frame;
  if (odometry->frame_id != expected && !std::exchange(frame_differs_, true))
    log::warning("odometry is in frame \"{}\", tf is told of \"{}\": set --odom-frame", odometry->frame_id,
                 expected);
  const Eigen::Vector3d t = odometry->T_odom_base.translation();
  const Eigen::Quaterniond q(odometry->T_odom_base.linear());
  std::optional<std::array<double, 36>> covariance;
  if (!odometry->covariance.isZero()) {  // ROS: all zero says unknown
    covariance.emplace();
    Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(covariance->data()) = odometry->covariance;
  }
  const auto taken = client_.push_odometry(odometry->stamp_ns,
                                           {{t.x(), t.y(), t.z()}, {q.x(), q.y(), q.z(), q.w()}}, covariance);
  if (!taken) complain(taken.error());
}

void SensorFeed::take_camera_info(const Result<Camera>& camera) {
  if (!camera) {
    if (!std::exchange(camera_unread_, true))
      log::warning("camera_info is left out: {}; the intrinsics in use stay", camera.error().message);
    return;
  }
  const client::Camera& c = options_.client.camera;
  const double off = std::max({std::abs(camera->fx - c.fx), std::abs(camera->fy - c.fy),
                               std::abs(camera->cx - c.cx), std::abs(camera->cy - c.cy)});
  const bool differs = camera->width != c.width || camera->height != c.height || off > 1.0;
  if (differs && !camera_differs_)
    log::limited(
        camera_lines_,
        "camera_info ({}x{}, fx {:.1f}) differs from the intrinsics in use ({}x{}, fx {:.1f}): correct {}",
        camera->width, camera->height, camera->fx, c.width, c.height, c.fx,
        options_.device_file.empty() ? "the driver" : options_.device_file);
  camera_differs_ = differs;
}

}  // namespace liloc
