#include "client/odometry/range_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "common/base/quantile.hpp"

namespace liloc {
namespace {

// The difference of two readings, sd at range z: at least a good time-of-flight sensor's, at most that of a
// Kinect (quantization of 2.85 mm/m2 and noise; Khoshelham and Elberink 2012), with some to spare.
constexpr double kLeastM = 0.003, kLeastPerM2 = 0.0003;  // by hand
// Standard deviations: at most, and before anything is learned; by hand.
constexpr double kMostM = 0.005, kMostPerM2 = 0.005;
constexpr double kSdOfMedian = 1.4826;      // of normally distributed values, by the median of their size
constexpr float kDown = 0.5F, kUp = 0.03F;  // per frame, by hand: quick to believe that it is quiet
constexpr int kStep = 6;                    // every sixth pixel in both axes: 2100 of 320x240; by hand
constexpr std::size_t kFewest = 20;         // pixels of a bin that have a median; by hand

}  // namespace

RangeNoise::RangeNoise(double depth_scale_m)
    : depth_scale_m_(depth_scale_m),
      bin_units_(std::max<std::size_t>(1, static_cast<std::size_t>(kBinM / depth_scale_m))) {
  for (std::size_t i = 0; i < kBins; ++i) {
    const double z = kBinM * (static_cast<double>(i) + 0.5);
    sd_units_[i] = static_cast<float>((kMostM + kMostPerM2 * z * z) / depth_scale_m_);
  }
}

void RangeNoise::learn(const DepthImage& before, const DepthImage& after) {
  std::array<std::vector<double>, kBins> differences;
  for (int v = 0; v < after.height; v += kStep)
    for (int u = 0; u < after.width; u += kStep) {
      const int a = before.at(u, v), b = after.at(u, v);
      if (a == 0 || b == 0) continue;
      differences[std::min<std::size_t>(static_cast<std::size_t>(a) / bin_units_, kBins - 1)].push_back(
          std::abs(a - b));
    }
  for (std::size_t i = 0; i < kBins; ++i) {
    if (differences[i].size() < kFewest) continue;
    const double half = median(std::move(differences[i]));
    if (half == 0) continue;  // the same frame once more
    const double z = kBinM * (static_cast<double>(i) + 0.5);
    const auto sd =
        static_cast<float>(std::clamp(kSdOfMedian * half, (kLeastM + kLeastPerM2 * z * z) / depth_scale_m_,
                                      (kMostM + kMostPerM2 * z * z) / depth_scale_m_));
    sd_units_[i] += (sd < sd_units_[i] ? kDown : kUp) * (sd - sd_units_[i]);
  }
}

}  // namespace liloc
