#pragma once
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"

namespace liloc::learned {

/// Named arrays of floats, as a safetensors file has them: eight bytes of length, a JSON header of so many
/// bytes, then the arrays, little-endian.
struct WeightsFile {
  struct Array {
    std::vector<std::size_t> shape;
    std::vector<float> values;  ///< finite, the last axis fastest
  };
  std::map<std::string, Array> arrays;
  std::map<std::string, std::string> about;  ///< the header's __metadata__

  static constexpr std::size_t kMostBytes = std::size_t{256} << 20;  ///< the paper's network has 35 MB; by hand
  static constexpr std::size_t kMostHeaderBytes = std::size_t{1} << 20;  ///< its header has 12 kB; by hand
};

/// Errors name the array and what is wrong with it: any byte of `bytes` may be hostile.
[[nodiscard]] Result<WeightsFile> parse_weights(std::string_view bytes);

/// Errors name the file, too: no regular file, unreadable, over kMostBytes, or as above.
[[nodiscard]] Result<WeightsFile> read_weights(const std::filesystem::path& file);

}  // namespace liloc::learned
