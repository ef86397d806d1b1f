#include "common/wire/convert_sensors.hpp"

#include <bit>
#include <cstdint>

#include "common/wire/convert.hpp"

namespace liloc::wire {
namespace {

static_assert(std::endian::native == std::endian::little, "samples are sent as they lie in memory");

constexpr std::uint32_t kMaxSide = 8192, kMaxPoints = 4'000'000;
constexpr float kMaxCoordinate_m = 1000.0F;
constexpr std::uint8_t kFloat32 = 7;  // PointField's code

Result<StampNs> stamp_of(const std_msgs_msg_dds__Header_& header) {
  if (header.stamp.sec < 0 || header.stamp.nanosec >= 1'000'000'000U)
    return fail("header.stamp is {} s {} ns, must not be negative, with less than 1e9 ns", header.stamp.sec,
                header.stamp.nanosec);
  return StampNs{header.stamp.sec} * 1'000'000'000 + header.stamp.nanosec;
}

template <class T>
T load(const std::uint8_t* from, bool big_endian) {
  std::array<std::uint8_t, sizeof(T)> bytes;
  std::memcpy(bytes.data(), from, sizeof(T));
  if (big_endian) std::ranges::reverse(bytes);
  return std::bit_cast<T>(bytes);
}

Status check_image(const sensor_msgs_msg_dds__Image_& m, std::uint64_t pixel_bytes) {
  if (m.width < 1 || m.width > kMaxSide || m.height < 1 || m.height > kMaxSide)
    return fail("image is {} x {}, must be 1..{} each way", m.width, m.height, kMaxSide);
  if (m.step < m.width * pixel_bytes)
    return fail("step is {}, {} pixels need {}", m.step, m.width, m.width * pixel_bytes);
  if (m.data._length != std::uint64_t{m.step} * m.height)
    return fail("data has {} bytes, step {} x height {} is {}", m.data._length, m.step, m.height,
                std::uint64_t{m.step} * m.height);
  return {};
}

std::uint16_t units_of(float metres, double depth_scale_m) {
  const double units = static_cast<double>(metres) / depth_scale_m;
  return std::isfinite(units) && units > 0 && units < 65535.5 ? static_cast<std::uint16_t>(std::lround(units))
                                                              : 0;
}

struct Xyz {
  std::uint32_t x = 0, y = 0, z = 0;
};

Result<Xyz> xyz_of(const sensor_msgs_msg_dds__PointCloud2_& m) {
  Xyz offsets;
  for (const auto& [name, offset] : {std::pair{"x", &offsets.x}, {"y", &offsets.y}, {"z", &offsets.z}}) {
    const auto* begin = m.fields._buffer;
    const auto* end = begin + m.fields._length;
    const auto* field = std::find_if(begin, end, [n = name](const auto& f) { return text_of(f.name) == n; });
    if (field == end) return fail("fields lack {}; x, y and z are needed", name);
    if (field->datatype != kFloat32)
      return fail("field {} has datatype {}, must be 7 (float32)", name, field->datatype);
    if (std::uint64_t{field->offset} + sizeof(float) > m.point_step)
      return fail("field {} at offset {} lies beyond point_step {}", name, field->offset, m.point_step);
    *offset = field->offset;
  }
  return offsets;
}

Status check_layout(const sensor_msgs_msg_dds__PointCloud2_& m) {
  const std::uint64_t count = std::uint64_t{m.width} * m.height;
  if (count > kMaxPoints)
    return fail("cloud has {} x {} points, must be up to {}", m.width, m.height, kMaxPoints);
  if (m.row_step < std::uint64_t{m.width} * m.point_step)
    return fail("row_step is {}, {} points of {} bytes need more", m.row_step, m.width, m.point_step);
  if (m.data._length != std::uint64_t{m.row_step} * m.height)
    return fail("data has {} bytes, row_step {} x height {} is {}", m.data._length, m.row_step, m.height,
                std::uint64_t{m.row_step} * m.height);
  return {};
}

}  // namespace

Result<DepthImage> from_wire(const sensor_msgs_msg_dds__Image_& m, double depth_scale_m) {
  const auto stamp_ns = stamp_of(m.header);
  if (!stamp_ns) return tl::unexpected(stamp_ns.error());
  const std::string encoding = text_of(m.encoding);
  const bool metres = encoding == "32FC1";
  if (!metres && encoding != "16UC1" && encoding != "mono16")
    return fail("encoding is \"{}\", must be 16UC1 or 32FC1", encoding);
  if (auto valid = check_image(m, metres ? 4 : 2); !valid) return tl::unexpected(valid.error());
  DepthImage image{*stamp_ns, static_cast<int>(m.width), static_cast<int>(m.height), {}};
  image.units.resize(std::size_t{m.width} * m.height);
  const bool big_endian = m.is_bigendian != 0;
  for (std::uint32_t v = 0; v < m.height; ++v) {
    const std::uint8_t* row = m.data._buffer + std::size_t{v} * m.step;
    std::uint16_t* units = image.units.data() + std::size_t{v} * m.width;
    if (!metres && !big_endian) {
      std::memcpy(units, row, 2 * std::size_t{m.width});
      continue;
    }
    for (std::uint32_t u = 0; u < m.width; ++u)
      units[u] = metres ? units_of(load<float>(row + 4 * std::size_t{u}, big_endian), depth_scale_m)
                        : load<std::uint16_t>(row + 2 * std::size_t{u}, big_endian);
  }
  return image;
}

Result<Camera> from_wire(const sensor_msgs_msg_dds__CameraInfo_& m) {
  if (const auto stamp_ns = stamp_of(m.header); !stamp_ns) return tl::unexpected(stamp_ns.error());
  if (m.width < 1 || m.width > kMaxSide || m.height < 1 || m.height > kMaxSide)
    return fail("camera_info is {} x {}, must be 1..{} each way", m.width, m.height, kMaxSide);
  if (m.k[1] != 0 || m.k[3] != 0 || m.k[6] != 0 || m.k[7] != 0 || m.k[8] != 1)
    return fail("k is not [fx 0 cx; 0 fy cy; 0 0 1]; publish the intrinsics of the rectified image");
  Camera camera{static_cast<int>(m.width), static_cast<int>(m.height), m.k[0], m.k[4], m.k[2], m.k[5]};
  return camera.validated("camera_info");
}

Result<StampedCloud> from_wire(const sensor_msgs_msg_dds__PointCloud2_& m) {
  const auto stamp_ns = stamp_of(m.header);
  if (!stamp_ns) return tl::unexpected(stamp_ns.error());
  const auto at = xyz_of(m);
  if (!at) return tl::unexpected(at.error());
  if (auto valid = check_layout(m); !valid) return tl::unexpected(valid.error());
  StampedCloud result{*stamp_ns, {}};
  auto& points = result.cloud_sensor.points;
  points.reserve(std::size_t{m.width} * m.height);
  for (std::uint32_t row = 0; row < m.height; ++row)
    for (std::uint32_t column = 0; column < m.width; ++column) {
      const std::uint8_t* p =
          m.data._buffer + std::size_t{row} * m.row_step + std::size_t{column} * m.point_step;
      const Eigen::Vector3f point(load<float>(p + at->x, m.is_bigendian),
                                  load<float>(p + at->y, m.is_bigendian),
                                  load<float>(p + at->z, m.is_bigendian));
      if (point.allFinite() && point.cwiseAbs().maxCoeff() <= kMaxCoordinate_m) points.push_back(point);
    }
  return result;
}

Result<ImuSample> from_wire(const sensor_msgs_msg_dds__Imu_& m) {
  const auto stamp_ns = stamp_of(m.header);
  if (!stamp_ns) return tl::unexpected(stamp_ns.error());
  const auto& w = m.angular_velocity;
  const auto& a = m.linear_acceleration;
  const ImuSample sample{*stamp_ns, {w.x, w.y, w.z}, {a.x, a.y, a.z}};
  if (!(sample.angular_velocity_rad_s.cwiseAbs().maxCoeff() < 200) ||
      !sample.angular_velocity_rad_s.allFinite())
    return fail("angular_velocity is ({}, {}, {}) rad/s, must be within 200", w.x, w.y, w.z);
  if (!(sample.specific_force_m_s2.cwiseAbs().maxCoeff() < 2000) || !sample.specific_force_m_s2.allFinite())
    return fail("linear_acceleration is ({}, {}, {}) m/s^2, must be within 2000", a.x, a.y, a.z);
  return sample;
}

Result<StampedOdometry> from_wire(const nav_msgs_msg_dds__Odometry_& m) {
  const auto stamp_ns = stamp_of(m.header);
  if (!stamp_ns) return tl::unexpected(stamp_ns.error());
  const auto& p = m.pose.pose.position;
  const auto& q = m.pose.pose.orientation;
  const auto pose = valid_pose({p.x, p.y, p.z}, {q.x, q.y, q.z, q.w}, "pose.pose");
  if (!pose) return tl::unexpected(pose.error());
  const Matrix6d ros = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(m.pose.covariance);
  if (!ros.allFinite() || ros.diagonal().minCoeff() < 0)
    return fail("pose.covariance is not finite or has a negative variance");
  StampedOdometry odometry{*stamp_ns, text_of(m.header.frame_id), *pose, {}};
  odometry.covariance << ros.block<3, 3>(3, 3), ros.block<3, 3>(3, 0), ros.block<3, 3>(0, 3),
      ros.block<3, 3>(0, 0);  // ROS has the position first
  return odometry;
}

std_msgs_msg_dds__Header_ header_of(StampNs stamp_ns, const std::string& frame_id) {
  std_msgs_msg_dds__Header_ header{};
  header.stamp.sec = static_cast<std::int32_t>(stamp_ns / 1'000'000'000);
  header.stamp.nanosec = static_cast<std::uint32_t>(stamp_ns % 1'000'000'000);
  copy_text(header.frame_id, frame_id);
  return header;
}

sensor_msgs_msg_dds__Image_ to_wire(const DepthImage& image, const std::string& frame_id) {
  sensor_msgs_msg_dds__Image_ m{};
  m.header = header_of(image.stamp_ns, frame_id);
  m.height = static_cast<std::uint32_t>(image.height);
  m.width = static_cast<std::uint32_t>(image.width);
  copy_text(m.encoding, "16UC1");
  m.step = 2 * m.width;
  m.data._maximum = m.data._length = static_cast<std::uint32_t>(image.units.size() * 2);
  m.data._buffer = reinterpret_cast<std::uint8_t*>(const_cast<std::uint16_t*>(image.units.data()));
  return m;
}

sensor_msgs_msg_dds__CameraInfo_ to_wire(const Camera& camera, StampNs stamp_ns, const std::string& frame_id) {
  sensor_msgs_msg_dds__CameraInfo_ m{};
  m.header = header_of(stamp_ns, frame_id);
  m.height = static_cast<std::uint32_t>(camera.height);
  m.width = static_cast<std::uint32_t>(camera.width);
  copy_text(m.distortion_model, "plumb_bob");
  m.k[0] = m.p[0] = camera.fx;
  m.k[2] = m.p[2] = camera.cx;
  m.k[4] = m.p[5] = camera.fy;
  m.k[5] = m.p[6] = camera.cy;
  m.k[8] = m.p[10] = 1;
  m.r[0] = m.r[4] = m.r[8] = 1;
  return m;
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

PointsSample to_wire(const Cloud& cloud_sensor, StampNs stamp_ns, const std::string& frame_id) {
  static_assert(sizeof(Eigen::Vector3f) == 12);
  PointsSample sample;
  auto& m = sample.message;
  m.header = header_of(stamp_ns, frame_id);
  m.height = 1;
  m.width = static_cast<std::uint32_t>(cloud_sensor.size());
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    auto& field = sample.fields.emplace_back();
    copy_text(field.name, std::string_view("xyz").substr(axis, 1));
    field.offset = 4 * axis;
    field.datatype = kFloat32;
    field.count = 1;
  }
  lend(m.fields, sample.fields);
  m.point_step = 12;
  m.row_step = m.point_step * m.width;
  m.data._maximum = m.data._length = m.row_step;
  m.data._buffer = const_cast<std::uint8_t*>(reinterpret_cast<const std::uint8_t*>(cloud_sensor.points.data()));
  m.is_dense = true;
  return sample;
}

}  // namespace liloc::wire
