#include <algorithm>

#include "common/geometry/camera_info.hpp"
#include "common/geometry/depth.hpp"
#include "common/wire/sensors/convert_header.hpp"
#include "common/wire/sensors/convert_sensors.hpp"

namespace liloc::wire {
namespace {

Status check_image(const sensor_msgs_msg_dds__Image_& m, std::uint64_t pixel_bytes) {
  if (m.width < 1 || m.width > kLargestSide || m.height < 1 || m.height > kLargestSide)
    return fail("image is {} x {}, must be 1..{} each way", m.width, m.height, kLargestSide);
  if (m.step < m.width * pixel_bytes)
    return fail("step is {}, {} pixels need {}", m.step, m.width, m.width * pixel_bytes);
  if (m.data._length != std::uint64_t{m.step} * m.height)
    return fail("data has {} bytes, step {} x height {} is {}", m.data._length, m.step, m.height,
                std::uint64_t{m.step} * m.height);
  return {};
}

std::uint16_t units_of(float metres, double depth_scale_m) {
  const double units = static_cast<double>(metres) / depth_scale_m;
  return std::isfinite(units) && units > 0 && units < 65534.5 ? static_cast<std::uint16_t>(std::lround(units))
                                                              : 0;
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
  mark_missing(image);
  return image;
}

Result<Camera> from_wire(const sensor_msgs_msg_dds__CameraInfo_& m) {
  if (const auto stamp_ns = stamp_of(m.header); !stamp_ns) return tl::unexpected(stamp_ns.error());
  CameraInfo info;
  info.height = m.height;
  info.width = m.width;
  std::ranges::copy(m.k, info.k.begin());
  std::ranges::copy(m.p, info.p.begin());
  info.binning_x = m.binning_x;
  info.binning_y = m.binning_y;
  info.roi = {m.roi.x_offset, m.roi.y_offset, m.roi.height, m.roi.width};
  return camera_of(info);
}

bool distorted(const sensor_msgs_msg_dds__CameraInfo_& m) {
  return std::any_of(m.d._buffer, m.d._buffer + m.d._length, [](double d) { return d != 0; });
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

}  // namespace liloc::wire
