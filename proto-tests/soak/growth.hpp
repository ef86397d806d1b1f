#pragma once
// Whether a figure that is sampled over hours grows.
#include <vector>

namespace liloc::soak {

struct Sample {
  double at_s = 0, value = 0;
};

struct Trend {
  double first = 0, last = 0;  ///< medians of the first and of the last third
  double spread = 0;           ///< of the first third: between its quartiles
  double slope_per_h = 0;      ///< Theil and Sen's: the median slope of all pairs; outliers do not move it
  [[nodiscard]] double growth() const { return last - first; }
};

/// Of the samples from `from_s` on, by rising time. All 0 where there are under three.
[[nodiscard]] Trend trend_of(const std::vector<Sample>& samples, double from_s);

}  // namespace liloc::soak
