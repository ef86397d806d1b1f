#include "common/geometry/extent.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/base/quantile.hpp"

namespace liloc {

double extent_m(const Cloud& cloud) {
  double longest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    for (const Eigen::Vector3f& p : cloud.points)
      if (p.allFinite()) values.push_back(p[axis]);
    if (values.empty()) return 0;
    const double high = quantile(values, 0.98);
    longest = std::max(longest, high - quantile(std::move(values), 0.02));
  }
  return longest;
}

}  // namespace liloc
