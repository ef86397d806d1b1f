#include "server/tools/ply_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <limits>

#include "common/recording/files.hpp"
#include "server/tools/ply_header.hpp"

namespace liloc::toolbox {
namespace {

constexpr std::size_t kLargestFile = std::size_t{4} << 30;   // by hand
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";  // of UTF-8: an editor saved an ASCII file
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Takes one number after the other off the data; past the end it is not sound any more.
class Values {
 public:
  Values(std::string_view data, PlyHeader::Format format)
      : data_(data),
        ascii_(format == PlyHeader::Format::ascii),
        swapped_((format == PlyHeader::Format::little) != (std::endian::native == std::endian::little)) {}

  [[nodiscard]] bool sound() const { return sound_; }
  /// The fewest bytes that `property` can take.
  [[nodiscard]] std::size_t least_bytes(const PlyProperty& property) const {
    return ascii_ ? 2 : bytes_of(property.list_length.value_or(property.type));
  }
  [[nodiscard]] std::size_t left() const { return data_.size(); }

  double next(Scalar type) { return ascii_ ? next_word() : next_binary(type); }

  void skip(const PlyProperty& property) {
    if (!property.list_length) {
      next(property.type);
      return;
    }
    const double length = next(*property.list_length);
    if (!(length >= 0 && length <= static_cast<double>(data_.size()))) sound_ = false;
    for (std::size_t i = 0; sound_ && i < static_cast<std::size_t>(length); ++i) next(property.type);
  }

 private:
  double next_binary(Scalar type) {
    const std::size_t size = bytes_of(type);
    if (data_.size() < size) sound_ = false;
    if (!sound_) return kNone;
    const double value = read_scalar(type, data_.data(), swapped_);
    data_.remove_prefix(size);
    return value;
  }

  double next_word() {
    constexpr std::string_view kBlanks = " \t\r\n";
    data_.remove_prefix(std::min(data_.find_first_not_of(kBlanks), data_.size()));
    const std::string_view word = data_.substr(0, data_.find_first_of(kBlanks));
    data_.remove_prefix(word.size());
    const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
    const char* const stop = word.data() + word.size();
    double value = kNone;
    const auto [end, error] = std::from_chars(begin, stop, value);
    if (end != stop || error == std::errc::invalid_argument) sound_ = false;
    return value;  // beyond a double: not finite, so the point is dropped
  }

  std::string_view data_;
  bool ascii_, swapped_, sound_ = true;
};

/// Where x, y and z stand among the vertices' properties.
Result<std::array<std::size_t, 3>> axes_of(const PlyElement& vertex) {
  for (const PlyProperty& property : vertex.properties)
    if (property.list_length) return fail("its vertices have a list, {}", property.name.substr(0, 40));
  std::array<std::size_t, 3> axes{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    const auto found = std::ranges::find(vertex.properties, name, &PlyProperty::name);
    if (found == vertex.properties.end()) return fail("its vertices have no {}", name);
    axes.at(axis) = static_cast<std::size_t>(found - vertex.properties.begin());
  }
  return axes;
}

Status check_room(const PlyElement& element, const Values& values) {
  std::size_t least = 0;
  for (const PlyProperty& property : element.properties) least += values.least_bytes(property);
  if (element.count <= (values.left() + 1) / std::max<std::size_t>(least, 1)) return {};
  return fail("claims {} of element {} in {} bytes", element.count, element.name.substr(0, 40), values.left());
}

Result<Points> read_vertices(const PlyElement& vertex, Values& values) {
  const auto axes = axes_of(vertex);
  if (!axes) return tl::unexpected(axes.error());
  Points points;
  points.reserve(vertex.count);
  std::vector<double> row(vertex.properties.size());
  for (std::size_t i = 0; i < vertex.count; ++i) {
    for (std::size_t k = 0; k < row.size(); ++k) row[k] = values.next(vertex.properties[k].type);
    if (!values.sound()) return fail("has no sound vertex {} of {}", i + 1, vertex.count);
    const Eigen::Vector3d p(row[(*axes)[0]], row[(*axes)[1]], row[(*axes)[2]]);
    if (p.cast<float>().allFinite()) points.push_back(p);
  }
  return points;
}

Result<Points> parse(std::string_view bytes) {
  if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
  const auto header = parse_ply_header(bytes);
  if (!header) return tl::unexpected(header.error());
  Values values(bytes.substr(header->bytes), header->format);
  for (const PlyElement& element : header->elements) {
    if (const Status fits = check_room(element, values); !fits) return tl::unexpected(fits.error());
    if (element.name == "vertex") return read_vertices(element, values);
    if (element.properties.empty()) continue;
    for (std::size_t i = 0; i < element.count && values.sound(); ++i)
      for (const PlyProperty& property : element.properties) values.skip(property);
    if (!values.sound()) return fail("ends within element {}", element.name.substr(0, 40));
  }
  return fail("has no element vertex");
}

}  // namespace

Result<Points> read_ply(const std::filesystem::path& file) {
  const auto bytes = read_file(file, kLargestFile);
  if (!bytes) return tl::unexpected(bytes.error());
  auto points = parse(*bytes);
  if (!points) return fail("{}: {}; write it anew", file.string(), points.error().message);
  return points;
}

}  // namespace liloc::toolbox
