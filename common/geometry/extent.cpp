#include "common/geometry/extent.hpp"

#include <algorithm>
#include <vector>

namespace liloc {

double extent_m(const Cloud& cloud) {
  double longest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    for (const Eigen::Vector3f& p : cloud.points)
      if (p.allFinite()) values.push_back(p[axis]);
    if (values.empty()) return 0;
    std::ranges::sort(values);
    const std::size_t cut = values.size() / 50;
    longest = std::max(longest, static_cast<double>(values[values.size() - 1 - cut] - values[cut]));
  }
  return longest;
}

}  // namespace liloc
