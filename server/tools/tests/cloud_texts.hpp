#pragma once
// PLY and PCD files as other programs write them, for the tests of this room.
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <string>
#include <vector>

namespace liloc::toolbox::test {

template <class T>
std::string bytes_of_number(double value, bool big) {
  const T typed = static_cast<T>(value);
  std::string bytes(reinterpret_cast<const char*>(&typed), sizeof(T));
  if (big) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

/// One PLY with a property and an element in front of what is wanted.
template <class T>
std::string ply_of(const std::vector<Eigen::Vector3d>& points, const std::string& format,
                   const std::string& type) {
  const bool ascii = format == "ascii", big = format == "binary_big_endian";
  std::string text = fmt::format(
      "ply\r\nformat {} 1.0\r\ncomment x\r\nobj_info num_cols 7\r\nelement camera 1\r\nproperty list uchar "
      "short parts\r\nelement vertex {}\r\nproperty uchar red\r\nproperty {} x\r\nproperty {} y\r\nproperty {} "
      "z\r\nelement face 0\r\nproperty list uchar int vertex_indices\r\nend_header\r\n",
      format, points.size(), type, type, type);
  text += ascii ? "2 5 6\n"
                : bytes_of_number<std::uint8_t>(2, big) + bytes_of_number<std::int16_t>(5, big) +
                      bytes_of_number<std::int16_t>(6, big);
  for (const auto& p : points)
    text += ascii ? fmt::format("9 {} {} {}\n", p.x(), p.y(), p.z())
                  : bytes_of_number<std::uint8_t>(9, big) + bytes_of_number<T>(p.x(), big) +
                        bytes_of_number<T>(p.y(), big) + bytes_of_number<T>(p.z(), big);
  return text;
}

template <class T>
std::string pcd_of(const std::vector<Eigen::Vector3d>& points, const std::string& data, char type) {
  std::string text = fmt::format(
      "VERSION .7\nFIELDS rgb x y z\nSIZE 4 {0} {0} {0}\nTYPE U {1} {1} {1}\nCOUNT 1 1 1 1\nWIDTH {2}\n"
      "HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {2}\nDATA {3}\n",
      sizeof(T), type, points.size(), data);
  for (const auto& p : points)
    text += data == "ascii" ? fmt::format("9 {} {} {}\n", p.x(), p.y(), p.z())
                            : bytes_of_number<std::uint32_t>(9, false) + bytes_of_number<T>(p.x(), false) +
                                  bytes_of_number<T>(p.y(), false) + bytes_of_number<T>(p.z(), false);
  return text;
}

}  // namespace liloc::toolbox::test
