#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"
#include "server/tools/scalar.hpp"

namespace liloc::toolbox {

struct PlyProperty {
  std::string name;
  Scalar type = Scalar::f32;          ///< of a list: of its values
  std::optional<Scalar> list_length;  ///< the type of its length; empty: no list
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  enum class Format { ascii, little, big };
  Format format = Format::ascii;
  std::vector<PlyElement> elements;  ///< in their order in the file
  std::size_t bytes = 0;             ///< of the header itself
};

/// Errors say what is wrong without the file's name.
[[nodiscard]] Result<PlyHeader> parse_ply_header(std::string_view bytes);

}  // namespace liloc::toolbox
