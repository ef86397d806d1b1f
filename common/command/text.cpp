#include "common/command/text.hpp"

#include <algorithm>

#include "common/base/text.hpp"

namespace liloc::command {
namespace {

// A name or a number, known again by its beginning; by hand.
constexpr std::size_t kExcerpt = 40;
constexpr std::size_t kLongestLine = 400, kKept = 190;  // a path, a field and a remedy fit; by hand

bool printable_ascii(char c) {
  return c >= ' ' && c <= '~';
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
  const std::string line = without_controls(text);
  if (line.size() <= kLongestLine) return line;
  return line.substr(0, kKept) + " ... " + line.substr(line.size() - kKept);
}

}  // namespace liloc::command
