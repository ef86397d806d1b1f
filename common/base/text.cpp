#include "common/base/text.hpp"

namespace liloc {
namespace {

/// Control characters of ASCII, and those that UTF-8 writes as C2 80 to C2 9F.
bool is_control(std::string_view text, std::size_t i) {
  const auto byte = static_cast<unsigned char>(text[i]);
  if (byte < 0x20 || byte == 0x7f) return true;
  const auto before = static_cast<unsigned char>(i > 0 ? text[i - 1] : 0);
  return before == 0xc2 && byte >= 0x80 && byte < 0xa0;
}

}  // namespace

std::string without_controls(std::string_view text) {
  std::string line(text);
  for (std::size_t i = 0; i < text.size(); ++i)
    if (is_control(text, i)) line[i] = text[i] == '\n' ? ' ' : '?';
  return line;
}

}  // namespace liloc
