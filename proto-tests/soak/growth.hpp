#pragma once
// Whether a figure that is sampled over hours grows.
#include <vector>

namespace liloc::soak {

struct Sample {
  double at_s = 0, value = 0;
};

/// A leak lifts the floor; what comes and goes with the load stands on it.
struct Trend {
  double first = 0, last = 0;  ///< floors of the first and of the last third: what a tenth of it lies below
  double third_s = 0;          ///< how long these last
  double slope_per_h = 0;      ///< Theil and Sen's: the median slope of all pairs; outliers do not move it
  [[nodiscard]] double growth() const { return last - first; }
};

/// Of the samples from `from_s` on, by rising time. All 0 where there are under three.
[[nodiscard]] Trend trend_of(const std::vector<Sample>& samples, double from_s);

}  // namespace liloc::soak
