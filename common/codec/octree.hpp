#pragma once
// Private to the room: an octree as the paper compresses with, kept for comparison. A 28-byte header (depth,
// count of leaves, corner, longest side), then one occupancy byte per inner node, breadth first.
#include "common/codec/codec.hpp"

namespace liloc::codec {

[[nodiscard]] Result<std::vector<std::uint8_t>> encode_octree(const Cloud& cloud, int depth);
[[nodiscard]] Result<Cloud> decode_octree(const std::vector<std::uint8_t>& bytes, std::size_t max_points);

}  // namespace liloc::codec
