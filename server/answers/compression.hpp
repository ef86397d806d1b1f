#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "common/base/result.hpp"

namespace liloc::answers {

/// One zstd frame that tells its size and carries a checksum.
[[nodiscard]] std::string compressed(std::string_view bytes);
/// Errors: no such frame, a damaged one, over `limit_bytes`.
[[nodiscard]] Result<std::string> decompressed(std::string_view frame, std::size_t limit_bytes);

}  // namespace liloc::answers
