#include "common/wire/sensors/convert_header.hpp"
#include "common/wire/sensors/convert_sensors.hpp"

namespace liloc::wire {
namespace {

constexpr std::uint32_t kMaxPoints = 4'000'000;  // memory bound; by hand
constexpr float kMaxCoordinate_m = 1000.0F;      // no indoor sensor sees as far; by hand
constexpr std::uint8_t kFloat32 = 7;             // PointField's code

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
  if (count > kMaxPoints || m.height > kMaxPoints)  // rows without points cost time as well
    return fail("cloud has {} x {} points, must be up to {}", m.width, m.height, kMaxPoints);
  if (m.row_step < std::uint64_t{m.width} * m.point_step)
    return fail("row_step is {}, {} points of {} bytes need more", m.row_step, m.width, m.point_step);
  if (m.data._length != std::uint64_t{m.row_step} * m.height)
    return fail("data has {} bytes, row_step {} x height {} is {}", m.data._length, m.row_step, m.height,
                std::uint64_t{m.row_step} * m.height);
  return {};
}

}  // namespace

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
