#pragma once
#include <array>
#include <numeric>

#include "common/geometry/camera.hpp"

namespace liloc {

/// How much a pixel that looks at the same surface differs from one frame to the next, by range; learned while
/// running. A device that moves makes all pixels differ, so the quieter frames count more, within what depth
/// sensors have at all. Not thread-safe.
class RangeNoise {
 public:
  explicit RangeNoise(double depth_scale_m);

  /// Two frames in a row, of one size.
  void learn(const DepthImage& before, const DepthImage& after);
  /// One standard deviation of the difference of two readings at this depth, in units of the image.
  [[nodiscard]] float sd_units(std::uint16_t depth) const {
    return sd_units_[std::min<std::size_t>(depth / bin_units_, kBins - 1)];
  }

  /// Over all depths: falls as it is learned.
  [[nodiscard]] double total() const { return std::accumulate(sd_units_.begin(), sd_units_.end(), 0.0); }

  static constexpr std::size_t kBins = 24;  ///< to 9.6 m, beyond the range of the sensors known; by hand
  static constexpr double kBinM = 0.4;      // by hand

 private:
  double depth_scale_m_;
  std::size_t bin_units_;
  std::array<float, kBins> sd_units_{};
};

}  // namespace liloc
