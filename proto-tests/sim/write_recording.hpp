#pragma once
#include <filesystem>
#include <functional>

#include "common/geometry/cloud.hpp"
#include "proto-tests/sim/base/options.hpp"

namespace liloc::sim {

/// Called on the caller's thread with the share done, 0..1, rising.
using Progress = std::function<void(double)>;

/// Simulates and writes a recording with its reference scan and ground truth. `root` is made; it must not hold
/// a recording yet. site.json comes last, so that what was interrupted does not open.
[[nodiscard]] Status write_recording(const SimOptions& options, const std::filesystem::path& root,
                                     const Progress& progress = {});

/// Binary little-endian PLY with float x, y, z.
[[nodiscard]] Status write_ply(const std::filesystem::path& file, const Cloud& cloud);

}  // namespace liloc::sim
