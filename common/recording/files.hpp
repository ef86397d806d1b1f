#pragma once
// Whole files in and out: what is read is bounded, what is written appears complete or not at all.
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "common/base/result.hpp"

namespace liloc {

/// A regular file's bytes. Errors: absent, not a regular file, unreadable, over `limit_bytes`.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& file, std::size_t limit_bytes);

/// Makes the folder if need be, writes beside `file` under a hidden name and renames.
[[nodiscard]] Status write_file(const std::filesystem::path& file, std::string_view bytes);

}  // namespace liloc
