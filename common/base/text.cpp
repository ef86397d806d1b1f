#include "common/base/text.hpp"

namespace liloc {
namespace {

/// Control characters of ASCII, and both bytes of those that UTF-8 writes as C2 80 to C2 9F.
bool is_control(std::string_view text, std::size_t i) {
  const auto byte_at = [&](std::size_t at) {
    return static_cast<unsigned char>(at < text.size() ? text[at] : '\0');
  };
  const auto is_second = [](unsigned char byte) { return byte >= 0x80 && byte < 0xa0; };
  const unsigned char byte = byte_at(i);
  if (byte < 0x20 || byte == 0x7f) return true;
  if (byte == 0xc2) return is_second(byte_at(i + 1));
  return i > 0 && byte_at(i - 1) == 0xc2 && is_second(byte);
}

}  // namespace

std::string without_controls(std::string_view text) {
  std::string line(text);
  for (std::size_t i = 0; i < text.size(); ++i)
    if (is_control(text, i)) line[i] = text[i] == '\n' ? ' ' : '?';
  return line;
}

}  // namespace liloc
