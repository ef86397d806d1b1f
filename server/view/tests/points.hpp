#pragma once
// A points message as the page reads it.
#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "common/geometry/cloud.hpp"

namespace liloc::view::test {

struct ReadPoints {
  int kind = 0;
  std::vector<Eigen::Vector3f> points_map;
};

template <class T>
T at(const std::string& bytes, std::size_t offset) {
  T value{};
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

inline ReadPoints read_points(const std::string& bytes) {
  ReadPoints read;
  if (bytes.size() < 32 || bytes.size() != 32 + 6 * std::size_t{at<std::uint32_t>(bytes, 4)}) {
    ADD_FAILURE() << "a points message of " << bytes.size() << " bytes";
    return read;
  }
  EXPECT_EQ(bytes[1], 1);
  read.kind = static_cast<unsigned char>(bytes[0]);
  const auto low = at<std::array<float, 3>>(bytes, 8), step = at<std::array<float, 3>>(bytes, 20);
  for (std::size_t offset = 32; offset < bytes.size(); offset += 6) {
    const auto n = at<std::array<std::uint16_t, 3>>(bytes, offset);
    read.points_map.emplace_back(low[0] + step[0] * n[0], low[1] + step[1] * n[1], low[2] + step[2] * n[2]);
  }
  return read;
}

}  // namespace liloc::view::test
