#include "common/learned/describer.hpp"

#include <algorithm>

#include "common/base/log.hpp"

namespace liloc::learned {
namespace {

constexpr int kFarthest = 4;  // voxels: a point of a cloud thinned to four voxels has one so near; by hand

/// As FCGF has them: each axis divided and rounded down. Points out of reach are no part of a room.
std::vector<Eigen::Vector3i> voxels_of(const Cloud& cloud, float voxel_m) {
  std::vector<Eigen::Vector3i> voxels;
  voxels.reserve(cloud.size());
  for (const Eigen::Vector3f& p : cloud.points) {
    const Eigen::Array3f at = (p.array() / voxel_m).floor();
    if ((at.abs() <= static_cast<float>(VoxelSet::kReach)).all()) voxels.emplace_back(at.cast<int>());
  }
  return voxels;
}

/// The offsets up to kFarthest, nearest first.
std::vector<Eigen::Vector3i> offsets_by_distance() {
  std::vector<Eigen::Vector3i> offsets;
  for (int z = -kFarthest; z <= kFarthest; ++z)
    for (int y = -kFarthest; y <= kFarthest; ++y)
      for (int x = -kFarthest; x <= kFarthest; ++x) offsets.emplace_back(x, y, z);
  std::ranges::stable_sort(offsets, {}, [](const Eigen::Vector3i& o) { return o.squaredNorm(); });
  return offsets;
}

/// -1: none is near.
std::int32_t nearest_row(const VoxelSet& set, const Eigen::Vector3f& p, float voxel_m,
                         const std::vector<Eigen::Vector3i>& offsets) {
  const Eigen::Array3f at = (p.array() / voxel_m).floor();
  if (!(at.abs() <= static_cast<float>(VoxelSet::kReach)).all()) return -1;
  const Eigen::Vector3i voxel = at.cast<int>();
  for (const Eigen::Vector3i& offset : offsets)
    if (const std::int32_t row = set.find(voxel + offset); row >= 0) return row;
  return -1;
}

Features describe_by(const FeatureNetwork& network, const Cloud& dense, const Cloud& thinned,
                     const std::vector<std::uint32_t>& index, int threads) {
  const auto voxel_m = static_cast<float>(network.voxel_size_m());
  Features features;
  features.descriptors.resize(network.dimensions(), 0);
  const auto set = VoxelSet::of(voxels_of(dense, voxel_m));
  if (!set) {
    log::warning("a cloud is not described: {}", set.error().message);
    return features;
  }
  const Tensor rows = network(network.maps(*set, threads), threads);
  static const std::vector<Eigen::Vector3i> offsets = offsets_by_distance();
  features.descriptors.resize(network.dimensions(), static_cast<Eigen::Index>(index.size()));
  for (const std::uint32_t i : index) {
    const std::int32_t row = nearest_row(*set, thinned.points[i], voxel_m, offsets);
    if (row < 0) continue;
    features.descriptors.col(static_cast<Eigen::Index>(features.index.size())) =
        rows.values.row(row).head(network.dimensions()).transpose();
    features.index.push_back(i);
  }
  features.descriptors.conservativeResize(Eigen::NoChange, static_cast<Eigen::Index>(features.size()));
  return features;
}

}  // namespace

Describer describer_of(std::shared_ptr<const FeatureNetwork> network, int threads) {
  return [network = std::move(network), threads](const Cloud& dense, const Cloud& thinned,
                                                 const std::vector<std::uint32_t>& index) {
    return describe_by(*network, dense, thinned, index, threads);
  };
}

Result<Describer> describer_from(std::string_view features, const std::filesystem::path& weights, int threads) {
  if (features == "fpfh") {
    if (weights.empty()) return Describer();
    return fail("--weights: fpfh needs none; add --features learned, or leave it out");
  }
  if (features != "learned") return fail("--features: '{}' is unknown; use fpfh or learned", features);
  if (weights.empty())
    return fail(
        "--features: learned needs --weights FILE; common/learned/convert_fcgf.py makes one of an FCGF "
        "checkpoint, or use fpfh");
  auto network = FeatureNetwork::load(weights);
  if (!network) return fail("--weights: {}", network.error().message);
  return describer_of(std::move(*network), threads);
}

}  // namespace liloc::learned
