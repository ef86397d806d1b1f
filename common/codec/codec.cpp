#include "common/codec/codec.hpp"

#include <algorithm>
#include <cmath>

#include "common/codec/draco.hpp"
#include "common/codec/octree.hpp"
#include "common/codec/voxel.hpp"

namespace liloc {
namespace {

Status check(const Cloud& cloud, std::string_view what) {
  for (const auto& p : cloud.points)
    if (!p.allFinite() || p.cwiseAbs().maxCoeff() > kMaxCoordinate_m)
      return fail("{}: point ({}, {}, {}) is not within {} m; drop such points first", what, p.x(), p.y(),
                  p.z(), kMaxCoordinate_m);
  return {};
}

Status check(const CodecOptions& options) {
  if (options.octree_depth < 4 || options.octree_depth > 12)
    return fail("octree_depth is {}, must be 4..12", options.octree_depth);
  if (!(options.voxel_size_m >= 0.01 && options.voxel_size_m <= 1))
    return fail("voxel_size_m is {}, must be 0.01..1", options.voxel_size_m);
  if (!(options.resolution_m >= 0.0001 && options.resolution_m <= 1))
    return fail("resolution_m is {}, must be 0.0001..1", options.resolution_m);
  return {};
}

Result<std::vector<std::uint8_t>> bytes_of(const Cloud& cloud, const CodecOptions& options) {
  switch (options.codec) {
    case CloudCodec::draco:
      return codec::encode_draco(cloud, options.resolution_m);
    case CloudCodec::octree:
      return codec::encode_octree(cloud, options.octree_depth);
    case CloudCodec::voxel:
      return codec::encode_voxel(
          cloud, options.voxel_size_m,
          std::min(codec::kMaxSteps, static_cast<int>(std::ceil(options.voxel_size_m / options.resolution_m))));
  }
  return fail("codec is {}, must be 1 (Draco), 2 (octree) or 3 (voxel)", static_cast<int>(options.codec));
}

Result<Cloud> cloud_of(const EncodedCloud& encoded, std::size_t max_points) {
  switch (encoded.codec) {
    case CloudCodec::draco:
      return codec::decode_draco(encoded.bytes, max_points);
    case CloudCodec::octree:
      return codec::decode_octree(encoded.bytes, max_points);
    case CloudCodec::voxel:
      return codec::decode_voxel(encoded.bytes, max_points);
  }
  return fail("codec is {}, must be 1 (Draco), 2 (octree) or 3 (voxel)", static_cast<int>(encoded.codec));
}

}  // namespace

Result<EncodedCloud> encode(const Cloud& cloud, const CodecOptions& options) {
  if (cloud.empty() || cloud.size() > kMaxCodecPoints)
    return fail("cloud to encode has {} points, must be 1..{}; downsample it", cloud.size(), kMaxCodecPoints);
  if (auto valid = check(options); !valid) return tl::unexpected(valid.error());
  if (auto valid = check(cloud, "cloud to encode"); !valid) return tl::unexpected(valid.error());
  auto bytes = bytes_of(cloud, options);
  if (!bytes) return tl::unexpected(bytes.error());
  return EncodedCloud{options.codec, std::move(*bytes)};
}

Result<Cloud> decode(const EncodedCloud& encoded, std::size_t max_points) {
  auto cloud = cloud_of(encoded, max_points);
  if (!cloud) return cloud;
  if (auto valid = check(*cloud, "decoded cloud"); !valid) return tl::unexpected(valid.error());
  return cloud;
}

}  // namespace liloc
