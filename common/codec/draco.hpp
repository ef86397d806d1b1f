#pragma once
// Private to the room: the Draco half of the codec.
#include "common/codec/codec.hpp"

namespace liloc::codec {

/// The step is `resolution_m`, or the longest side / 65535 where that is more.
[[nodiscard]] Result<std::vector<std::uint8_t>> encode_draco(const Cloud& cloud, double resolution_m);
[[nodiscard]] Result<Cloud> decode_draco(const std::vector<std::uint8_t>& bytes, std::size_t max_points);

}  // namespace liloc::codec
