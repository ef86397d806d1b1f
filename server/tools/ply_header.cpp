#include "server/tools/ply_header.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "common/command/text.hpp"

namespace liloc::toolbox {
namespace {

using command::excerpt;

// A sound header is far shorter; by hand.
constexpr std::size_t kLongestHeader = 1 << 16, kMostElements = 16, kMostProperties = 256;
constexpr std::size_t kMostItems = 50'000'000;  // as for PCD: far beyond a building, and 2 GB at most

std::optional<Scalar> scalar_of(const std::string& name) {
  static constexpr std::pair<std::string_view, Scalar> kNames[] = {
      {"char", Scalar::i8},   {"int8", Scalar::i8},     {"uchar", Scalar::u8},   {"uint8", Scalar::u8},
      {"short", Scalar::i16}, {"int16", Scalar::i16},   {"ushort", Scalar::u16}, {"uint16", Scalar::u16},
      {"int", Scalar::i32},   {"int32", Scalar::i32},   {"uint", Scalar::u32},   {"uint32", Scalar::u32},
      {"float", Scalar::f32}, {"float32", Scalar::f32}, {"double", Scalar::f64}, {"float64", Scalar::f64}};
  const auto found = std::ranges::find(kNames, name, &std::pair<std::string_view, Scalar>::first);
  if (found == std::end(kNames)) return std::nullopt;
  return found->second;
}

using Words = std::vector<std::string>;

Words words_of(std::string_view line) {
  std::istringstream in{std::string(line)};
  Words words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

Status read_format(const Words& words, PlyHeader& header) {
  const std::string name = words.size() > 1 ? words[1] : "";
  if (name == "ascii")
    header.format = PlyHeader::Format::ascii;
  else if (name == "binary_little_endian")
    header.format = PlyHeader::Format::little;
  else if (name == "binary_big_endian")
    header.format = PlyHeader::Format::big;
  else
    return fail("its format is '{}'; PLY has ascii, binary_little_endian and binary_big_endian", excerpt(name));
  return {};
}

Status read_element(const Words& words, PlyHeader& header) {
  PlyElement element;
  if (words.size() != 3 || header.elements.size() == kMostElements) return fail("has an unsound element");
  element.name = words[1];
  const std::string& count = words[2];
  const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
  if (error != std::errc() || end != count.data() + count.size() || element.count > kMostItems)
    return fail("claims '{}' of element {}, at most {} are read", excerpt(count), excerpt(element.name),
                kMostItems);
  header.elements.push_back(std::move(element));
  return {};
}

Status read_property(const Words& words, PlyHeader& header) {
  const bool list = words.size() == 5 && words[1] == "list";
  if (header.elements.empty() || (!list && words.size() != 3) ||
      header.elements.back().properties.size() == kMostProperties)
    return fail("has an unsound property");
  PlyProperty property;
  property.name = words.back();
  const auto type = scalar_of(words[words.size() - 2]);
  if (list) property.list_length = scalar_of(words[2]);
  if (!type || (list && !property.list_length))
    return fail("its property {} has a type '{}' that PLY does not know", excerpt(property.name),
                excerpt(type ? words[2] : words[words.size() - 2]));
  property.type = *type;
  header.elements.back().properties.push_back(std::move(property));
  return {};
}

Status read_line(const Words& words, PlyHeader& header) {
  if (words.empty()) return {};
  if (words[0] == "format") return read_format(words, header);
  if (words[0] == "element") return read_element(words, header);
  if (words[0] == "property") return read_property(words, header);
  if (words[0] == "comment" || words[0] == "obj_info") return {};
  return fail("its header has a line '{}'", excerpt(words[0]));
}

}  // namespace

Result<PlyHeader> parse_ply_header(std::string_view bytes) {
  PlyHeader header;
  const std::string_view head = bytes.substr(0, kLongestHeader);
  for (std::size_t at = 0, number = 0; at < head.size(); ++number) {
    const std::size_t end = head.find('\n', at);
    if (end == std::string_view::npos) break;
    const Words words = words_of(head.substr(at, end - at));
    at = end + 1;
    if (number == 0 && (words.empty() || words[0] != "ply")) break;
    if (number == 0) continue;
    if (!words.empty() && words[0] == "end_header") {
      header.bytes = at;
      return header;
    }
    if (const Status read = read_line(words, header); !read) return tl::unexpected(read.error());
  }
  return fail("has no PLY header");
}

}  // namespace liloc::toolbox
