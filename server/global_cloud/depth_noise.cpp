#include "server/global_cloud/depth_noise.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace liloc {
namespace {

// Width of a bin: a sensor's noise changes little within; by hand.
constexpr double kRange_m = 0.5;
constexpr double kLeast_m = 0.00025;           // half the finest unit of the sensors known
constexpr double kGrowth = 1.16;               // of the bins of size, up to 0.27 m
constexpr std::uint32_t kEnough = 300;         // pairs in a range's bin that count: their median is good to 5 %
constexpr std::uint32_t kFade = 100'000;       // pairs in a bin; then half are forgotten; by hand
constexpr int kFitEvery = 8;                   // frames; by hand
constexpr double kShareGain = 0.05;            // of a frame in the shares: a memory of 20 frames; by hand
constexpr double kOfMedian = 1.4826 / 1.4142;  // a frame's standard deviation over the median of differences
// In the fit: below, units and steps say more than noise; by hand.
constexpr double kFinest_m = 0.003;

}  // namespace

void NoiseMeter::add_pair(double z_m, double apart_m) {
  const int bin = std::min(static_cast<int>(z_m / kRange_m), kRanges - 1);
  const double size = std::max(0.0, std::log(std::abs(apart_m) / kLeast_m + 1e-9) / std::log(kGrowth) + 1);
  Range& range = ranges_[static_cast<std::size_t>(std::max(bin, 0))];
  ++range.counts[static_cast<std::size_t>(std::min(static_cast<int>(size), kSizes - 1))];
  if (++range.all < kFade) return;
  range.all = 0;
  for (std::uint32_t& count : range.counts) range.all += count /= 2;
}

void NoiseMeter::add_frame(int known, int missing, int returns, int flying) {
  const auto follow = [](double& share, int part, int whole) {
    if (whole > 0) share += kShareGain * (static_cast<double>(part) / whole - share);
  };
  follow(noise_.missing, missing, known);
  follow(noise_.flying, flying, returns);
  if (++frames_ % kFitEvery == 0) fit();
}

double NoiseMeter::median_of(const Range& range) {
  double below = 0;
  const double half = 0.5 * range.all;
  for (int i = 0; i < kSizes; ++i) {
    const double here = range.counts[static_cast<std::size_t>(i)];
    if (below + here < half) {
      below += here;
      continue;
    }
    const double low = i == 0 ? 0 : kLeast_m * std::pow(kGrowth, i - 1), high = kLeast_m * std::pow(kGrowth, i);
    return low + (high - low) * (half - below) / std::max(here, 1.0);
  }
  return kLeast_m;
}

/// Least squares over the ranges' medians, each relative to itself, so that far ones do not rule.
void NoiseMeter::fit() {
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  std::uint64_t samples = 0;
  int bins = 0;
  for (int i = 0; i < kRanges; ++i) {
    const Range& range = ranges_[static_cast<std::size_t>(i)];
    if (range.all < kEnough) continue;
    const double z = (i + 0.5) * kRange_m, sigma = kOfMedian * median_of(range);
    const double weight = 1 / std::max(sigma, kFinest_m);
    const Eigen::Vector2d row(weight, weight * z * z);
    A += row * row.transpose();
    b += weight * sigma * row;
    samples += range.all;
    ++bins;
  }
  if (bins == 0) return;
  const double det = A.determinant();
  Eigen::Vector2d fitted(b.x() / A(0, 0), 0);  // a constant, unless two ranges or more say better
  if (bins > 1 && det > 1e-9 * A(0, 0) * A(1, 1)) fitted = A.inverse() * b;
  if (fitted.y() < 0) fitted = {b.x() / A(0, 0), 0};
  if (fitted.x() < 0) fitted = {0, b.y() / A(1, 1)};
  noise_.base_m = fitted.x();
  noise_.per_square_m = fitted.y();
  noise_.samples = samples;
}

}  // namespace liloc
