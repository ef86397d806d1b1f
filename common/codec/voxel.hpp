#pragma once
// Private to the room: our own coder of clouds that lie on a voxel grid, one point in most voxels. A 28-byte
// header, then one adaptive range-coded stream: which cells of an octree are occupied, level by level, each bit
// in the context of its neighbours; then where in its voxel each point lies, by what the voxels around
// foretell. All of the decoder's arithmetic is in integers, so that every computer decodes the same.
#include "common/codec/codec.hpp"

namespace liloc::codec {

constexpr int kMaxSteps = 64;  // an offset fits six bits

/// `steps`: 1..kMaxSteps, into which a voxel's side is divided. Errors: a cloud that spans over 2^18 voxels.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_voxel(const Cloud& cloud, double voxel_size_m,
                                                             int steps);
[[nodiscard]] Result<Cloud> decode_voxel(const std::vector<std::uint8_t>& bytes, std::size_t max_points);

}  // namespace liloc::codec
