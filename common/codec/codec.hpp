#pragma once
// Clouds to bytes and back. Bytes come from a network: decoding trusts nothing in them.
//
//   const Result<EncodedCloud> lpc = encode(cloud_sensor);   // about 2.1 bytes a point at 0.05 m
//   const Result<Cloud> cloud = decode(*lpc);                // the same points, in another order
#include <cstddef>

#include "common/geometry/cloud.hpp"
#include "common/protocol/spot.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct CodecOptions {
  CloudCodec codec = CloudCodec::draco;
  double voxel_size_m = 0.05;  ///< voxel: 0.01..1, the grid that the points lie on, best one in each cell
  /// Draco and voxel: the step of a coordinate, 0.0001..1; RMSE is half of it (1.5 mm). It is coarser where
  /// the code cannot hold it: voxel has 64 steps to a voxel, Draco 65535 to the cloud's longest side.
  double resolution_m = 0.003;
  /// Octree (paper, section 3.1.3): 4..12; a leaf is the longest side / 2^depth, and merges its points.
  int octree_depth = 8;
};

// Memory bound: a 640x480 frame at 0.03 m has 12 000 points (paper, section 3.1.3); by hand.
constexpr std::size_t kMaxCodecPoints = 100'000;
constexpr float kMaxCoordinate_m = 1000.0F;  // as in common/wire/sensors/convert_points.cpp; by hand

/// Points only: normals are made anew by the receiver. Pure. Errors: an empty cloud, over kMaxCodecPoints, a
/// point that is not finite or beyond 1 km, options out of range.
[[nodiscard]] Result<EncodedCloud> encode(const Cloud& cloud, const CodecOptions& options = {});

/// Never throws, and never allocates for more than `max_points`. Errors: a damaged stream, more points than
/// `max_points`, no points, a decoded point that is not finite or beyond 1 km. The order of points is not kept.
[[nodiscard]] Result<Cloud> decode(const EncodedCloud& encoded, std::size_t max_points = kMaxCodecPoints);

}  // namespace liloc
