#include "common/codec/draco.hpp"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud_builder.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>

namespace liloc::codec {
namespace {

// What Draco 1.5's kd-tree encoder writes ahead of the points for one float position attribute. The count
// stands in it twice, and Draco writes as many points as the second says into room for the first; a decoder of
// clouds from a network therefore takes this layout and no other.
constexpr std::array<std::uint8_t, 11> kMagic = {'D', 'R', 'A', 'C', 'O', 2, 3, 0, 1, 0, 0};
// Of Draco's own layout, as its encoder here writes it: one attribute of three floats, and where what stands.
constexpr std::array<std::uint8_t, 7> kAttribute = {1, 1, 0, 9, 3, 0, 0};
constexpr std::size_t kCountAt = 11, kAttributeAt = 15, kLevelAt = 22, kBitsAt = 23, kSecondCountAt = 27;
constexpr std::size_t kHeaderBytes = 31;
constexpr int kFewestBits = 1, kMostBits = 16;

std::uint32_t u32_at(const std::vector<std::uint8_t>& bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) | static_cast<std::uint32_t>(bytes[at + 1]) << 8 |
         static_cast<std::uint32_t>(bytes[at + 2]) << 16 | static_cast<std::uint32_t>(bytes[at + 3]) << 24;
}

Result<std::uint32_t> checked_count(const std::vector<std::uint8_t>& bytes, std::size_t max_points) {
  if (bytes.size() < kHeaderBytes) return fail("Draco stream of {} bytes is cut short", bytes.size());
  if (!std::equal(kMagic.begin(), kMagic.end(), bytes.begin()) ||
      !std::equal(kAttribute.begin(), kAttribute.end(), bytes.begin() + kAttributeAt) || bytes[kLevelAt] > 6 ||
      u32_at(bytes, kBitsAt) > kMostBits)
    return fail("not a Draco kd-tree cloud of positions; encode with liloc::encode");
  const std::uint32_t count = u32_at(bytes, kCountAt);
  if (count == 0 || count > max_points)
    return fail("Draco stream claims {} points, must be 1..{}", count, max_points);
  if (u32_at(bytes, kSecondCountAt) != count)
    return fail("Draco stream is damaged: it has two counts of points");
  return count;
}

/// The cube that is cut into steps, counted from the lower corner of the cloud.
struct Grid {
  Eigen::Vector3f corner = Eigen::Vector3f::Zero();
  float side_m = 0;
  int bits = kFewestBits;
};

Grid grid_of(const Cloud& cloud, double resolution_m) {
  Eigen::AlignedBox3f box;
  for (const auto& p : cloud.points) box.extend(p);
  Grid grid{box.min(), 0, kFewestBits};
  const double side_m = static_cast<double>(box.sizes().maxCoeff());
  const auto steps = [&] { return static_cast<double>((1U << grid.bits) - 1); };
  while (steps() * resolution_m < side_m && grid.bits < kMostBits) ++grid.bits;
  grid.side_m = static_cast<float>(std::max(side_m, steps() * resolution_m));
  return grid;
}

}  // namespace

Result<std::vector<std::uint8_t>> encode_draco(const Cloud& cloud, double resolution_m) {
  draco::PointCloudBuilder builder;
  builder.Start(static_cast<draco::PointIndex::ValueType>(cloud.size()));
  const int position = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (std::uint32_t i = 0; i < cloud.size(); ++i)
    builder.SetAttributeValueForPoint(position, draco::PointIndex(i), cloud.points[i].data());
  const auto points = builder.Finalize(false);  // equal points stay: the count is the caller's
  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::POINT_CLOUD_KD_TREE_ENCODING);
  const Grid grid = grid_of(cloud, resolution_m);
  encoder.SetAttributeExplicitQuantization(draco::GeometryAttribute::POSITION, grid.bits, 3, grid.corner.data(),
                                           grid.side_m);
  encoder.SetSpeedOptions(0, 0);
  draco::EncoderBuffer buffer;
  if (const auto status = encoder.EncodePointCloudToBuffer(*points, &buffer); !status.ok())
    return fail("Draco cannot encode {} points: {}", cloud.size(), status.error_msg_string());
  return std::vector<std::uint8_t>(buffer.data(), buffer.data() + buffer.size());
}

Result<Cloud> decode_draco(const std::vector<std::uint8_t>& bytes, std::size_t max_points) {
  const auto count = checked_count(bytes, max_points);
  if (!count) return tl::unexpected(count.error());
  try {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodePointCloudFromBuffer(&buffer);
    if (!decoded.ok()) return fail("Draco stream is damaged: {}", decoded.status().error_msg_string());
    const auto* position = decoded.value()->GetNamedAttribute(draco::GeometryAttribute::POSITION);
    if (position == nullptr || position->num_components() != 3 || position->data_type() != draco::DT_FLOAT32 ||
        decoded.value()->num_points() != *count)
      return fail("Draco stream is damaged: its points are not those of its header");
    Cloud cloud;
    cloud.points.resize(*count);
    for (std::uint32_t i = 0; i < *count; ++i)
      position->GetMappedValue(draco::PointIndex(i), cloud.points[i].data());
    return cloud;
  } catch (const std::exception& error) {  // bad_alloc, length_error: a stream that asks for too much
    return fail("Draco stream is damaged: {}", error.what());
  }
}

}  // namespace liloc::codec
