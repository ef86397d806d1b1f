#pragma once
// The pairs of code and value that a DXF file is made of, gathered into entities.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace liloc::toolbox {

struct DxfGroup {
  int code = 0;
  double number = 0;  ///< 0 where the value is none
};

/// A thing drawn, or a variable of the header (its `type` then begins with `$`).
struct DxfEntity {
  std::string type;
  std::vector<DxfGroup> groups;  ///< of numbers alone, in the file's order

  /// The first of a code; 0 without one.
  [[nodiscard]] double number(int code) const;
};

/// Gives each variable of the header and each entity of ENTITIES in turn to `take`; what it fails with ends the
/// reading. Errors name the file, the line and the remedy: absent, over 64 MiB, binary DXF, no DXF, a number
/// that is none or not finite.
[[nodiscard]] Status read_dxf_entities(const std::filesystem::path& file,
                                       const std::function<Status(const DxfEntity&)>& take);

}  // namespace liloc::toolbox
