#pragma once
// Weights as the bytes of a file, for tests.
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "common/learned/weights_file.hpp"

namespace liloc::learned {

inline std::string with_header(const std::string& header, const std::string& data = {}) {
  const auto length = static_cast<std::uint64_t>(header.size());
  std::string bytes(sizeof length, '\0');
  std::memcpy(bytes.data(), &length, sizeof length);
  return bytes + header + data;
}

inline std::string bytes_of(const WeightsFile& file) {
  nlohmann::json header{{"__metadata__", file.about}};
  std::string data;
  for (const auto& [name, array] : file.arrays) {
    const std::size_t begin = data.size();
    data.append(reinterpret_cast<const char*>(array.values.data()), array.values.size() * sizeof(float));
    header[name] = {{"dtype", "F32"}, {"shape", array.shape}, {"data_offsets", {begin, data.size()}}};
  }
  return with_header(header.dump(), data);
}

}  // namespace liloc::learned
