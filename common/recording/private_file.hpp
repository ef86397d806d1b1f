#pragma once
#include <filesystem>
#include <string_view>

#include "common/base/result.hpp"

namespace liloc {

/// As `write_file`; the file, and what is written of it first, is its owner's alone at any moment.
[[nodiscard]] Status write_private_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace liloc
