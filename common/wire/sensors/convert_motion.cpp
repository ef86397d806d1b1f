#include "common/wire/sensors/convert_header.hpp"
#include "common/wire/sensors/convert_sensors.hpp"

namespace liloc::wire {
namespace {

// What bounds the arithmetic alone: degrees per second, millimetres and wild samples are known for that by
// whoever compares them with the motion, and counted there. By hand.
constexpr double kMostRate = 1e4, kMostForce = 1e5;

}  // namespace

std_msgs_msg_dds__Header_ header_of(StampNs stamp_ns, const std::string& frame_id) {
  std_msgs_msg_dds__Header_ header{};
  header.stamp.sec = static_cast<std::int32_t>(stamp_ns / 1'000'000'000);
  header.stamp.nanosec = static_cast<std::uint32_t>(stamp_ns % 1'000'000'000);
  copy_text(header.frame_id, frame_id);
  return header;
}

Result<ImuSample> from_wire(const sensor_msgs_msg_dds__Imu_& m) {
  const auto stamp_ns = stamp_of(m.header);
  if (!stamp_ns) return tl::unexpected(stamp_ns.error());
  const auto& w = m.angular_velocity;
  const auto& a = m.linear_acceleration;
  const ImuSample sample{*stamp_ns, {w.x, w.y, w.z}, {a.x, a.y, a.z}};
  if (!(sample.angular_velocity_rad_s.cwiseAbs().maxCoeff() < kMostRate) ||
      !sample.angular_velocity_rad_s.allFinite())
    return fail("angular_velocity is ({}, {}, {}) rad/s, must be within {}", w.x, w.y, w.z, kMostRate);
  if (!(sample.specific_force_m_s2.cwiseAbs().maxCoeff() < kMostForce) ||
      !sample.specific_force_m_s2.allFinite())
    return fail("linear_acceleration is ({}, {}, {}) m/s^2, must be within {}", a.x, a.y, a.z, kMostForce);
  return sample;
}

sensor_msgs_msg_dds__Imu_ to_wire(const ImuSample& sample, const std::string& frame_id) {
  sensor_msgs_msg_dds__Imu_ m{};
  m.header = header_of(sample.stamp_ns, frame_id);
  m.orientation.w = 1;
  m.orientation_covariance[0] = -1;  // ROS: no orientation is given
  const auto& w = sample.angular_velocity_rad_s;
  const auto& a = sample.specific_force_m_s2;
  m.angular_velocity = {w.x(), w.y(), w.z()};
  m.linear_acceleration = {a.x(), a.y(), a.z()};
  return m;
}

Result<StampedOdometry> from_wire(const nav_msgs_msg_dds__Odometry_& m) {
  const auto stamp_ns = stamp_of(m.header);
  if (!stamp_ns) return tl::unexpected(stamp_ns.error());
  const auto& p = m.pose.pose.position;
  const auto& q = m.pose.pose.orientation;
  const auto pose = valid_pose({p.x, p.y, p.z}, {q.x, q.y, q.z, q.w}, "pose.pose");
  if (!pose) return tl::unexpected(pose.error());
  const Matrix6d ros = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(m.pose.covariance);
  StampedOdometry odometry{*stamp_ns, text_of(m.header.frame_id), *pose, {}};
  odometry.covariance << ros.block<3, 3>(3, 3), ros.block<3, 3>(3, 0), ros.block<3, 3>(0, 3),
      ros.block<3, 3>(0, 0);  // ROS has the position first
  return odometry;
}

}  // namespace liloc::wire
