#include "common/codec/codec.hpp"

#include "common/codec/draco.hpp"
#include "common/codec/octree.hpp"

namespace liloc {
namespace {

Status check(const Cloud& cloud, std::string_view what) {
  for (const auto& p : cloud.points)
    if (!p.allFinite() || p.cwiseAbs().maxCoeff() > kMaxCoordinate_m)
      return fail("{}: point ({}, {}, {}) is not within {} m; drop such points first", what, p.x(), p.y(),
                  p.z(), kMaxCoordinate_m);
  return {};
}

}  // namespace

Result<EncodedCloud> encode(const Cloud& cloud, const CodecOptions& options) {
  if (cloud.empty() || cloud.size() > kMaxCodecPoints)
    return fail("cloud to encode has {} points, must be 1..{}; downsample it", cloud.size(), kMaxCodecPoints);
  if (options.quantization_bits < 6 || options.quantization_bits > 16)
    return fail("quantization_bits is {}, must be 6..16", options.quantization_bits);
  if (options.octree_depth < 4 || options.octree_depth > 12)
    return fail("octree_depth is {}, must be 4..12", options.octree_depth);
  if (auto valid = check(cloud, "cloud to encode"); !valid) return tl::unexpected(valid.error());
  const bool draco = options.codec == CloudCodec::draco;
  auto bytes = draco ? codec::encode_draco(cloud, options.quantization_bits)
                     : codec::encode_octree(cloud, options.octree_depth);
  if (!bytes) return tl::unexpected(bytes.error());
  return EncodedCloud{options.codec, std::move(*bytes)};
}

Result<Cloud> decode(const EncodedCloud& encoded, std::size_t max_points) {
  if (encoded.codec != CloudCodec::draco && encoded.codec != CloudCodec::octree)
    return fail("codec is {}, must be 1 (Draco) or 2 (octree)", static_cast<int>(encoded.codec));
  auto cloud = encoded.codec == CloudCodec::draco ? codec::decode_draco(encoded.bytes, max_points)
                                                  : codec::decode_octree(encoded.bytes, max_points);
  if (!cloud) return cloud;
  if (auto valid = check(*cloud, "decoded cloud"); !valid) return tl::unexpected(valid.error());
  return cloud;
}

}  // namespace liloc
