#include "common/command/text.hpp"

#include <algorithm>

namespace liloc::command {
namespace {

// A name or a number, known again by its beginning; by hand.
constexpr std::size_t kExcerpt = 40;
constexpr std::size_t kLongestLine = 400, kKept = 190;  // a path, a field and a remedy fit; by hand

bool printable_ascii(char c) {
  return c >= ' ' && c <= '~';
}

/// Control characters of ASCII, and those that UTF-8 writes as C2 80 to C2 9F.
bool is_control(std::string_view text, std::size_t i) {
  const auto byte = static_cast<unsigned char>(text[i]);
  if (byte < 0x20 || byte == 0x7f) return true;
  const auto before = static_cast<unsigned char>(i > 0 ? text[i - 1] : 0);
  return before == 0xc2 && byte >= 0x80 && byte < 0xa0;
}

}  // namespace

std::string excerpt(std::string_view text) {
  std::string shown(text.substr(0, kExcerpt));
  std::ranges::replace_if(
      shown, [](char c) { return !printable_ascii(c); }, '?');
  if (text.size() > kExcerpt) shown += "...";
  return shown;
}

std::string one_line(std::string_view text) {
  std::string line(text);
  for (std::size_t i = 0; i < text.size(); ++i)
    if (is_control(text, i)) line[i] = text[i] == '\n' ? ' ' : '?';
  if (line.size() <= kLongestLine) return line;
  return line.substr(0, kKept) + " ... " + line.substr(line.size() - kKept);
}

}  // namespace liloc::command
