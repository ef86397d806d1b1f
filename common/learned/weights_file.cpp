#include "common/learned/weights_file.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

namespace liloc::learned {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are taken as they lie in the file");

using Json = nlohmann::json;
constexpr int kDeepest = 3;  // of the header: the numbers of a shape

/// The header as JSON, no deeper than it has to be, no key twice.
Result<Json> parse_header(std::string_view text) {
  std::set<std::string> names;
  std::string twice;
  bool deep = false;
  const auto watch = [&](int depth, Json::parse_event_t event, Json& value) {
    if (event == Json::parse_event_t::key && depth == 1 && !names.insert(value.get<std::string>()).second)
      twice = value.get<std::string>();
    deep = deep || depth > kDeepest;
    return depth <= kDeepest;
  };
  Json header = Json::parse(text.begin(), text.end(), watch, false);
  if (header.is_discarded() || !header.is_object() || deep) return fail("its header is no JSON of safetensors");
  if (!twice.empty()) return fail("its header names {} twice", Json(twice).dump());
  return header;
}

/// A list of so many numbers that are not negative; empty: it is something else.
std::vector<std::size_t> numbers_of(const Json& fields, const char* name) {
  const auto found = fields.find(name);
  if (found == fields.end() || !found->is_array()) return {};
  std::vector<std::size_t> numbers;
  for (const Json& item : *found) {
    if (!item.is_number_unsigned()) return {};
    numbers.push_back(item.get<std::size_t>());
  }
  return numbers;
}

/// Of a shape; 0: more than any file has.
std::size_t count_of(const std::vector<std::size_t>& shape) {
  std::size_t count = 1;
  for (const std::size_t n : shape) {
    if (n == 0 || n > WeightsFile::kMostBytes / count) return 0;
    count *= n;
  }
  return count;
}

Result<WeightsFile::Array> parse_array(const Json& fields, std::string_view data) {
  if (!fields.is_object() || fields.value("dtype", Json()) != "F32") return fail("is not of dtype F32");
  WeightsFile::Array array{numbers_of(fields, "shape"), {}};
  const std::vector<std::size_t> offsets = numbers_of(fields, "data_offsets");
  const std::size_t count = count_of(array.shape);
  if (array.shape.empty() || count == 0) return fail("has no usable shape");
  if (offsets.size() != 2 || offsets[0] > offsets[1] || offsets[1] > data.size())
    return fail("lies outside of the file");
  if (offsets[1] - offsets[0] != count * sizeof(float)) return fail("has another size than its shape");
  array.values.resize(count);
  std::memcpy(array.values.data(), data.data() + offsets[0], count * sizeof(float));
  if (!std::ranges::all_of(array.values, [](float v) { return std::isfinite(v); }))
    return fail("has values that are no numbers");
  return array;
}

Status parse_about(const Json& fields, std::map<std::string, std::string>* about) {
  if (!fields.is_object()) return fail("__metadata__ is no object");
  for (const auto& [name, value] : fields.items()) {
    if (!value.is_string()) return fail("__metadata__ has a value that is no text");
    about->emplace(name, value.get<std::string>());
  }
  return {};
}

}  // namespace

Result<WeightsFile> parse_weights(std::string_view bytes) {
  std::uint64_t length = 0;
  if (bytes.size() < sizeof length) return fail("it is too short for weights");
  std::memcpy(&length, bytes.data(), sizeof length);
  bytes.remove_prefix(sizeof length);
  if (length > bytes.size() || length > WeightsFile::kMostHeaderBytes)
    return fail("it is not in the format of safetensors, or cut off");
  const auto header = parse_header(bytes.substr(0, length));
  if (!header) return tl::unexpected(header.error());
  const std::string_view data = bytes.substr(length);
  WeightsFile file;
  std::size_t total = 0;
  for (const auto& [name, fields] : header->items()) {
    if (name == "__metadata__") {
      if (const Status status = parse_about(fields, &file.about); !status)
        return tl::unexpected(status.error());
      continue;
    }
    auto array = parse_array(fields, data);
    if (!array) return fail("{} {}", Json(name).dump(), array.error().message);
    total += array->values.size() * sizeof(float);
    if (total > data.size()) return fail("its arrays share bytes");
    file.arrays.emplace(name, std::move(*array));
  }
  return file;
}

Result<WeightsFile> read_weights(const std::filesystem::path& path) {
  std::error_code trouble;
  if (!std::filesystem::is_regular_file(path, trouble))
    return fail("{}: no such file, or no regular one", path.string());
  const std::uintmax_t size = std::filesystem::file_size(path, trouble);
  if (trouble || size > WeightsFile::kMostBytes)
    return fail("{}: larger than {} MiB; no network for features is", path.string(),
                WeightsFile::kMostBytes >> 20);
  std::string bytes(size, '\0');
  std::ifstream in(path, std::ios::binary);
  if (!in.read(bytes.data(), static_cast<std::streamsize>(size)))
    return fail("{}: cannot be read", path.string());
  auto file = parse_weights(bytes);
  if (!file) return fail("{}: {}", path.string(), file.error().message);
  return file;
}

}  // namespace liloc::learned
