#include "common/recording/bags/ros_messages.hpp"

#include <cmath>
#include <limits>

#include "common/geometry/camera_info.hpp"
#include "common/recording/bags/cdr.hpp"

namespace liloc::bags {
namespace {

constexpr std::int64_t kNsInSecond = 1'000'000'000;
constexpr std::uint8_t kFloat32 = 7;  // of sensor_msgs/msg/PointField

tl::unexpected<Error> cut_short() {
  return fail("is no such message, or cut short; record it anew");
}

Status header(CdrIn& in, Header& message) {
  const auto seconds = in.number<std::int32_t>();
  const auto nanoseconds = in.number<std::uint32_t>();
  message.frame_id = in.text();
  if (!in.good()) return cut_short();
  if (seconds < 0 || nanoseconds >= kNsInSecond)
    return fail("has the stamp {} s, {} ns; stamps count from 1970", seconds, nanoseconds);
  message.stamp_ns = seconds * kNsInSecond + nanoseconds;
  return {};
}

/// A number at a byte, in the message's own byte order, which need not be that of its CDR.
template <class T>
T number_at(std::string_view bytes, std::size_t at, bool big_endian) {
  std::array<char, sizeof(T)> raw{};
  std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), sizeof(T), raw.begin());
  if (big_endian) std::reverse(raw.begin(), raw.end());
  T value{};
  std::memcpy(&value, raw.data(), sizeof(T));
  return value;
}

std::uint16_t units_of(float metres, double depth_scale_m) {
  const double value = std::round(metres / depth_scale_m);
  return value > 0 && value <= std::numeric_limits<std::uint16_t>::max() ? static_cast<std::uint16_t>(value)
                                                                         : 0;
}

Pose pose_in(CdrIn& in, Status* status) {
  const auto t = in.doubles<3>();
  const auto q = in.doubles<4>();
  const auto T = valid_pose({t[0], t[1], t[2]}, {q[0], q[1], q[2], q[3]}, "transform");
  if (!T && *status && in.good()) *status = tl::unexpected(T.error());
  return T.value_or(Pose::Identity());
}

/// Where x, y and z stand in a point.
Result<std::array<std::size_t, 3>> coordinates(CdrIn& in) {
  constexpr std::size_t kMissing = std::numeric_limits<std::size_t>::max();
  std::array<std::size_t, 3> at{kMissing, kMissing, kMissing};
  for (std::size_t left = in.length(13); left > 0 && in.good(); --left) {
    const std::string name = in.text();
    const auto offset = in.number<std::uint32_t>();
    const auto type = in.number<std::uint8_t>();
    (void)in.number<std::uint32_t>();  // count
    if (name.size() != 1 || name[0] < 'x' || name[0] > 'z') continue;
    if (type != kFloat32) return fail("has {} of type {}; give float32 (7)", name, type);
    at[static_cast<std::size_t>(name[0] - 'x')] = offset;
  }
  if (!in.good()) return cut_short();
  if (std::ranges::find(at, kMissing) != at.end()) return fail("lacks x, y or z");
  return at;
}

}  // namespace

Result<Header> header_of(std::string_view cdr) {
  CdrIn in(cdr);
  Header message;
  if (const Status read = header(in, message); !read) return tl::unexpected(read.error());
  return message;
}

Result<Framed<DepthImage>> depth_image(std::string_view cdr, double depth_scale_m) {
  CdrIn in(cdr);
  Framed<DepthImage> message;
  if (const Status read = header(in, message); !read) return tl::unexpected(read.error());
  const std::size_t height = in.number<std::uint32_t>(), width = in.number<std::uint32_t>();
  const std::string encoding = in.text();
  const bool big_endian = in.number<std::uint8_t>() != 0;
  const std::size_t step = in.number<std::uint32_t>();
  const std::string_view data = in.take(in.length());
  if (!in.good()) return cut_short();
  const bool metres = encoding == "32FC1";
  if (!metres && encoding != "16UC1" && encoding != "mono16")
    return fail("has the encoding '{}'; depth is 16UC1, mono16 or 32FC1", encoding.substr(0, 40));
  const std::size_t each = metres ? 4 : 2;
  if (width < 1 || height < 1 || width > kLargestSide || height > kLargestSide)
    return fail("is {}x{}; an image has 1 to {} pixels each way", width, height, kLargestSide);
  if (step < width * each || data.size() / step < height)
    return fail("is {}x{} in steps of {} with {} bytes; they do not go together", width, height, step,
                data.size());
  DepthImage& image = message.value;
  image = {message.stamp_ns, static_cast<int>(width), static_cast<int>(height), {}};
  image.units.reserve(width * height);
  for (std::size_t v = 0; v < height; ++v)
    for (std::size_t u = 0; u < width; ++u) {
      const std::size_t at = v * step + u * each;
      image.units.push_back(metres ? units_of(number_at<float>(data, at, big_endian), depth_scale_m)
                                   : number_at<std::uint16_t>(data, at, big_endian));
    }
  return message;
}

Result<Framed<Camera>> camera_info(std::string_view cdr) {
  CdrIn in(cdr);
  Framed<Camera> message;
  if (const Status read = header(in, message); !read) return tl::unexpected(read.error());
  CameraInfo info;
  info.height = in.number<std::uint32_t>();
  info.width = in.number<std::uint32_t>();
  (void)in.text();                                                                    // distortion model
  for (std::size_t left = in.length(8); left > 0; --left) (void)in.number<double>();  // its coefficients
  info.k = in.doubles<9>();
  (void)in.doubles<9>();  // r
  info.p = in.doubles<12>();
  for (std::uint32_t* value : {&info.binning_x, &info.binning_y, &info.roi.x_offset, &info.roi.y_offset,
                               &info.roi.height, &info.roi.width})
    *value = in.number<std::uint32_t>();
  if (!in.good()) return cut_short();
  const auto camera = liloc::camera_of(info);
  if (!camera) return tl::unexpected(camera.error());
  message.value = *camera;
  return message;
}

Result<Framed<ImuSample>> imu(std::string_view cdr) {
  CdrIn in(cdr);
  Framed<ImuSample> message;
  if (const Status read = header(in, message); !read) return tl::unexpected(read.error());
  (void)in.doubles<13>();  // orientation and its covariance
  const auto w = in.doubles<3>();
  (void)in.doubles<9>();
  const auto a = in.doubles<3>();
  if (!in.good()) return cut_short();
  message.value = {message.stamp_ns, {w[0], w[1], w[2]}, {a[0], a[1], a[2]}};
  if (!message.value.angular_velocity_rad_s.allFinite() || !message.value.specific_force_m_s2.allFinite())
    return fail("has a value that is not finite");
  return message;
}

Result<Framed<Cloud>> point_cloud(std::string_view cdr) {
  CdrIn in(cdr);
  Framed<Cloud> message;
  if (const Status read = header(in, message); !read) return tl::unexpected(read.error());
  const std::size_t height = in.number<std::uint32_t>(), width = in.number<std::uint32_t>();
  const auto at = coordinates(in);
  if (!at) return tl::unexpected(at.error());
  const bool big_endian = in.number<std::uint8_t>() != 0;
  const std::size_t point_step = in.number<std::uint32_t>(), row_step = in.number<std::uint32_t>();
  const std::string_view data = in.take(in.length());
  if (!in.good()) return cut_short();
  if (point_step < 12 || std::ranges::max(*at) + 4 > point_step || width > data.size() / point_step ||
      row_step < width * point_step || (row_step > 0 && height > data.size() / row_step))
    return fail("is {}x{} points of {} bytes in rows of {} with {} bytes; they do not go together", width,
                height, point_step, row_step, data.size());
  for (std::size_t v = 0; v < height && width > 0; ++v)
    for (std::size_t u = 0; u < width; ++u) {
      const std::size_t point = v * row_step + u * point_step;
      Eigen::Vector3f p;
      for (std::size_t i = 0; i < 3; ++i)
        p[static_cast<Eigen::Index>(i)] = number_at<float>(data, point + (*at)[i], big_endian);
      if (p.allFinite()) message.value.points.push_back(p);
    }
  return message;
}

Result<std::vector<Transform>> transforms(std::string_view cdr) {
  CdrIn in(cdr);
  std::vector<Transform> all;
  for (std::size_t left = in.length(60); left > 0 && in.good(); --left) {
    Framed<Transform> message;
    if (const Status read = header(in, message); !read) return tl::unexpected(read.error());
    message.value.parent = message.frame_id;
    message.value.child = in.text();
    Status valid;
    message.value.T_parent_child = pose_in(in, &valid);
    if (!valid) return tl::unexpected(valid.error());
    all.push_back(std::move(message.value));
  }
  if (!in.good()) return cut_short();
  return all;
}

}  // namespace liloc::bags
