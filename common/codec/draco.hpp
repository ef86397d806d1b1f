#pragma once
// Private to the room: the Draco half of the codec.
#include "common/codec/codec.hpp"

namespace liloc::codec {

[[nodiscard]] Result<std::vector<std::uint8_t>> encode_draco(const Cloud& cloud, int quantization_bits);
[[nodiscard]] Result<Cloud> decode_draco(const std::vector<std::uint8_t>& bytes, std::size_t max_points);

}  // namespace liloc::codec
