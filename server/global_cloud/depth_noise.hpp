#pragma once
// How a ceiling LiDAR errs, learned from its pixels that see what stands still.
#include <array>
#include <cstdint>

namespace liloc {

/// Plain data; the defaults are those of a sensor of which nothing is known yet.
struct DepthNoise {
  double base_m = 0.003, per_square_m = 0.0005;  ///< standard deviation at depth z: base + per_square z^2
  double missing = 0;                            ///< share of frames without a return where a surface is known
  double flying = 0;                             ///< share of returns that no surface and no body explains
  std::uint64_t samples = 0;                     ///< it rests on

  [[nodiscard]] double sigma_m(double z_m) const { return base_m + per_square_m * z_m * z_m; }
  friend bool operator==(const DepthNoise&, const DepthNoise&) = default;
};

/// Gathers differences from frame to frame by range and fits them. Old ones fade, so that it follows a sensor
/// that changes. Not thread-safe; an estimate costs microseconds.
class NoiseMeter {
 public:
  /// `known`: what an earlier run learned; stands until there are samples of this one.
  explicit NoiseMeter(const DepthNoise& known = {}) : noise_(known) {}

  /// Two returns of a pixel after another, at `z_m` and `apart_m` apart: what moves is in the minority.
  void add_pair(double z_m, double apart_m);
  /// Of one frame: pixels that know a surface, those of them without a return, all returns, and unexplained
  /// ones.
  void add_frame(int known, int missing, int returns, int flying);

  /// As of the last `add_frame`.
  [[nodiscard]] const DepthNoise& noise() const { return noise_; }

 private:
  static constexpr int kRanges = 24, kSizes = 48;  ///< to 12 m in bins of 0.5 m, and to 0.27 m in bins of size
  struct Range {
    std::array<std::uint32_t, kSizes> counts{};  ///< of differences by their size
    std::uint32_t all = 0;
  };
  [[nodiscard]] static double median_of(const Range& range);
  void fit();

  std::array<Range, kRanges> ranges_;
  int frames_ = 0;
  DepthNoise noise_;
};

}  // namespace liloc
