#pragma once
// Fast Point Feature Histograms (Rusu, Blodow, Beetz: ICRA 2009), as PCL defines them.
#include <cstdint>
#include <vector>

#include "common/registration/features/features.hpp"

namespace liloc {

// Rusu, Blodow, Beetz 2009: three histograms of eleven bins.
inline constexpr int kFpfhSize = 33;

/// Describes the points `index` of a cloud with normals by their neighbours within `radius_m`. Only what these
/// points need is computed: describing one point in eight costs about a quarter of describing all.
[[nodiscard]] Features fpfh(const Cloud& cloud, const std::vector<std::uint32_t>& index, double radius_m);

/// Every point whose hash under `seed` falls into one of `1/share`: the paper's random sampling (section 5.2),
/// done before the features are computed.
[[nodiscard]] std::vector<std::uint32_t> sample_indices(std::size_t count, double share, std::uint64_t seed);

}  // namespace liloc
