#pragma once
// Who comes and goes when: drawn by the seed before the run begins. Times in seconds since its start.
#include <cstddef>
#include <vector>

#include "proto-tests/soak/options.hpp"

namespace liloc::soak {

struct Span {
  double from_s = 0, to_s = 0;
  [[nodiscard]] double length_s() const { return to_s - from_s; }
  [[nodiscard]] bool holds(double at_s) const { return at_s >= from_s && at_s < to_s; }
};

/// When a ceiling LiDAR is away, one after another; it is there at first and at the end.
[[nodiscard]] std::vector<Span> draw_flaps(const SoakOptions& options, std::size_t lidar);

/// When somebody is in a visitor's place, one after another.
[[nodiscard]] std::vector<Span> draw_visits(const SoakOptions& options, std::size_t place);

}  // namespace liloc::soak
