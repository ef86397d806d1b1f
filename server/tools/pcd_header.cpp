#include "server/tools/pcd_header.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "common/command/text.hpp"

namespace liloc::toolbox {
namespace {

using Words = std::vector<std::string>;
constexpr std::array kKeywords{"VERSION", "FIELDS", "COLUMNS",   "SIZE",   "TYPE", "COUNT",
                               "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};
// A sound header is far shorter; 50 million points are far beyond a building. By hand.
constexpr int kMostLines = 64;
constexpr std::size_t kLongestLine = 4096, kMostFields = 64;
constexpr double kMostPoints = 50e6, kMostOfAField = 4096;

Words words_of(const std::string& line) {
  std::istringstream in(line);
  Words words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

/// Keyword to the words after it, up to and with DATA; empty: no PCD header.
std::map<std::string, Words> read_header(std::istream& in) {
  std::map<std::string, Words> header;
  std::string line(kLongestLine, '\0');
  for (int i = 0; i < kMostLines && in.getline(line.data(), static_cast<std::streamsize>(line.size())); ++i) {
    const auto length = std::min(line.size(), static_cast<std::size_t>(in.gcount()));
    if (std::memchr(line.data(), '\0', length > 0 ? length - 1 : 0) != nullptr)
      return {};  // PCL reads on behind it
    Words words = words_of(line.c_str());
    if (words.empty() || words.front().starts_with('#')) continue;
    const std::string keyword = words.front();
    if (std::ranges::find(kKeywords, keyword) == kKeywords.end()) return {};
    header[keyword] = Words(words.begin() + 1, words.end());
    if (keyword == "DATA") return header;
  }
  return {};
}

/// The keyword that follows DATA, empty where none does: PCL takes it for more of the header.
std::string keyword_after_data(std::istream& in) {
  in.clear();  // the file may end with the line
  const auto data_at = in.tellg();
  for (in >> std::ws; in.peek() == '#'; in >> std::ws)
    in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  std::string word(std::strlen("VIEWPOINT"), '\0');  // the longest
  in.read(word.data(), static_cast<std::streamsize>(word.size()));
  in.clear();
  in.seekg(data_at);
  const auto found = std::ranges::find_if(kKeywords, [&](const char* one) { return word.starts_with(one); });
  return found == kKeywords.end() ? "" : *found;
}

/// A whole number in [low, high], or -1.
double whole(const Words& words, std::size_t at, double low, double high) {
  if (at >= words.size()) return -1;
  char* end = nullptr;
  const double value = std::strtod(words[at].c_str(), &end);
  const bool sound = end != words[at].c_str() && *end == '\0' && value >= low && value <= high &&
                     value == static_cast<double>(static_cast<long long>(value));
  return sound ? value : -1;
}

/// Bytes of one point, or -1 where a field is unsound.
double bytes_of_point(const std::map<std::string, Words>& header, std::size_t fields) {
  const Words& sizes = header.at("SIZE");
  double bytes = 0;
  for (std::size_t i = 0; i < fields; ++i) {
    const double size = whole(sizes, i, 1, 8);
    const double count = header.contains("COUNT") ? whole(header.at("COUNT"), i, 1, kMostOfAField) : 1;
    if (size < 0 || count < 0) return -1;
    bytes += size * count;
  }
  return bytes;
}

/// The first field among x, y and z that is no single number of a type PCD knows, with that type; empty: none.
std::string odd_axis(const std::map<std::string, Words>& header) {
  constexpr std::array kTypes{"F4", "F8", "I1", "I2", "I4", "U1", "U2", "U4"};
  const Words& fields = header.at("FIELDS");
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (fields[i] != "x" && fields[i] != "y" && fields[i] != "z") continue;
    const std::string type = header.at("TYPE")[i] + header.at("SIZE")[i];
    const bool one = !header.contains("COUNT") || whole(header.at("COUNT"), i, 1, 1) == 1;
    if (!one || std::ranges::find(kTypes, type) == kTypes.end())
      return fmt::format("{} is TYPE {} SIZE {}{}", fields[i], command::excerpt(header.at("TYPE")[i]),
                         command::excerpt(header.at("SIZE")[i]), one ? "" : " with a COUNT");
  }
  return {};
}

/// Compressed data begin with their two lengths; PCL makes room for what the second says.
bool unpacks_to(std::istream& in, double bytes, double left) {
  std::array<std::uint32_t, 2> lengths{};
  in.read(reinterpret_cast<char*>(lengths.data()), sizeof(lengths));
  return in && lengths[0] + sizeof(lengths) <= left && lengths[1] == bytes;
}

}  // namespace

Status check_pcd_header(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::ifstream in(file, std::ios::binary);
  const auto header = read_header(in);
  for (const char* keyword : {"FIELDS", "SIZE", "TYPE", "WIDTH", "HEIGHT", "DATA"})
    if (!header.contains(keyword)) return fail("{}: has no PCD header with {}; write it anew", name, keyword);
  const std::size_t fields = header.at("FIELDS").size();
  if (fields > kMostFields || header.at("SIZE").size() != fields || header.at("TYPE").size() != fields)
    return fail("{}: {} FIELDS, {} SIZEs and {} TYPEs do not go together; write it anew", name, fields,
                header.at("SIZE").size(), header.at("TYPE").size());
  for (const char* axis : {"x", "y", "z"})
    if (std::ranges::find(header.at("FIELDS"), axis) == header.at("FIELDS").end())
      return fail("{}: its FIELDS have no {}; write it anew", name, axis);
  const double each = bytes_of_point(header, fields);
  if (each < 0) return fail("{}: a SIZE or COUNT is out of range; write it anew", name);
  if (const std::string odd = odd_axis(header); !odd.empty())
    return fail("{}: its field {}, which is not read; write it as F 4 or F 8", name, odd);
  const double width = whole(header.at("WIDTH"), 0, 0, kMostPoints),
               height = whole(header.at("HEIGHT"), 0, 0, kMostPoints);
  const double points =
      header.contains("POINTS") ? whole(header.at("POINTS"), 0, 0, kMostPoints) : width * height;
  if (width < 0 || height < 0 || points != width * height || points > kMostPoints)
    return fail("{}: WIDTH, HEIGHT and POINTS do not go together, or are over {}; write it anew", name,
                kMostPoints);
  const std::string kind = header.at("DATA").empty() ? "" : header.at("DATA").front();
  if (kind != "ascii" && kind != "binary" && kind != "binary_compressed")
    return fail("{}: its DATA is '{}'; PCD has ascii, binary and binary_compressed", name,
                command::excerpt(kind));
  if (const std::string more = keyword_after_data(in); !more.empty())
    return fail("{}: has {} after DATA; write it anew", name, more);
  const double left = static_cast<double>(std::filesystem::file_size(file)) - static_cast<double>(in.tellg());
  if (left < (kind == "binary" ? points * each : 0) || (kind == "ascii" && left < points) ||
      (kind == "binary_compressed" && points > 0 && !unpacks_to(in, points * each, left)))
    return fail("{}: claims {} points, which its {} bytes of {} data are not; write it anew", name, points,
                left, kind);
  return {};
}

}  // namespace liloc::toolbox
