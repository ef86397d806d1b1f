#pragma once
// The part of TOML that options need: `name = value`, with texts, numbers, true, false and lists of those.
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"

namespace liloc::command {

struct TomlEntry {
  std::string key;
  std::vector<std::string> values;  ///< one, or those of a list; texts without their quotes
  bool list = false;
  int line = 0;  ///< where the key stands, from 1
};

/// Reads a whole file's text; a byte order mark before it and ends of lines as on Windows are harmless. Errors
/// name `file` and the line: a section, a key that stands twice, no `=`, a text without its closing quote or
/// without quotes, a control character, an end in the middle.
[[nodiscard]] Result<std::vector<TomlEntry>> parse_toml(std::string_view text, std::string_view file);

}  // namespace liloc::command
