#pragma once
#include <string_view>

namespace liloc::view {

/// A file of the page, as it is built into the program.
struct Asset {
  std::string_view path;  ///< from which it is served
  std::string_view content_type;
  std::string_view gzip;  ///< its bytes, compressed
};

/// Null where there is none of that path.
[[nodiscard]] const Asset* asset_of(std::string_view path);

}  // namespace liloc::view
