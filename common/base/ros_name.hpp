#pragma once
#include <algorithm>
#include <string>

namespace liloc {

/// An id in the names of topics, which have no hyphens, in ROS as in DDS: they become underscores.
[[nodiscard]] inline std::string ros_name(std::string id) {
  std::ranges::replace(id, '-', '_');
  return id;
}

}  // namespace liloc
