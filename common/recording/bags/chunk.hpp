#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "common/base/result.hpp"
#include "common/recording/bags/limits.hpp"

namespace liloc::bags {

/// An MCAP chunk's records: `compression` "", "zstd" or "lz4" (frame format). Errors: another one, damage,
/// another size than `size`, over kLargestChunk.
[[nodiscard]] Result<std::string> unpacked(std::string_view compression, std::string_view packed,
                                           std::uint64_t size);

}  // namespace liloc::bags
