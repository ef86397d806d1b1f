// Compressed clouds, as requests bring them.
#include "common/codec/codec.hpp"
#include "proto-tests/fuzz/border.hpp"

namespace liloc::fuzz {
namespace {

Cloud corner(int side) {
  Cloud cloud;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const float u = 0.07F * static_cast<float>(i), v = 0.06F * static_cast<float>(j);
      cloud.points.insert(cloud.points.end(), {{u, v, 2.0F}, {u, 1.5F, 1.0F + v}, {-1.0F, u, 1.0F + v}});
    }
  return cloud;
}

Status read(CloudCodec codec, const std::string& bytes) {
  const auto cloud = decode({codec, {bytes.begin(), bytes.end()}});
  if (!cloud) return tl::unexpected(cloud.error());
  require(!cloud->empty() && cloud->size() <= kMaxCodecPoints, "the cloud has no points or too many");
  for (const auto& p : cloud->points)
    require(p.allFinite() && p.cwiseAbs().maxCoeff() <= kMaxCoordinate_m, "a point is far off or not finite");
  return {};
}

}  // namespace

std::vector<Border> cloud_code_borders() {
  std::vector<Border> all;
  for (const auto& [codec, name] : {std::pair{CloudCodec::draco, "lpc-draco"},
                                    {CloudCodec::octree, "lpc-octree"},
                                    {CloudCodec::voxel, "lpc-voxel"}}) {
    Border border{.name = name, .seeds = {}, .read = [codec = codec](const std::string& bytes) {
                    return read(codec, bytes);
                  }};
    for (const int side : {1, 4, 12}) {
      const auto encoded = encode(corner(side), {.codec = codec});
      require(encoded.has_value(), "a seed cannot be encoded");
      border.seeds.emplace_back(encoded->bytes.begin(), encoded->bytes.end());
    }
    all.push_back(std::move(border));
  }
  return all;
}

}  // namespace liloc::fuzz
