#pragma once
#include <filesystem>

#include "common/base/result.hpp"

namespace liloc::toolbox {

/// Whether a PCD file's header is sound and what it claims fits into the file: PCL believes the header, makes
/// room for whatever it says and reads past the end of what is not there. Errors name the file, the line's
/// keyword and the remedy.
[[nodiscard]] Status check_pcd_header(const std::filesystem::path& file);

}  // namespace liloc::toolbox
