#pragma once
#include <filesystem>
#include <string_view>

#include "common/learned/feature_network.hpp"
#include "common/registration/features/features.hpp"

namespace liloc::learned {

/// Describes points by a network: `dense` in its voxels, each point as the occupied voxel nearest to it; points
/// farther than four voxels from any are left out. A cloud that is too large is not described, which the log
/// tells. `threads` for each cloud.
[[nodiscard]] Describer describer_of(std::shared_ptr<const FeatureNetwork> network, int threads);

/// What the options --features and --weights ask for; empty for fpfh. Errors name the option and the remedy.
[[nodiscard]] Result<Describer> describer_from(std::string_view features, const std::filesystem::path& weights,
                                               int threads);

}  // namespace liloc::learned
