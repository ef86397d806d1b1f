#include "client/engine/input_health.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "common/base/quantile.hpp"

namespace liloc {
namespace {

constexpr int kEmptyFrames = 15;                           // in a row; by hand
constexpr std::size_t kMatches = 60, kFewestMatches = 30;  // by hand
// 31 walks, DECISIONS.md.
constexpr double kLargeStrain = 1.8;  // of 60 matches 12 exceeded it at most, where all was right ...
constexpr std::ptrdiff_t kStrainedMatches = 24;  // ... and 20 to 60 with 10 % of focal length
constexpr double kLargeResidual =
    0.012;  // a right calibration has 4 to 7 mm in furnished rooms, noise included

}  // namespace

void InputHealth::note(FrameFault fault, double residual_m, double strain) {
  empty_ = fault == FrameFault::too_few_points ? empty_ + 1 : 0;
  if (residual_m <= 0) return;
  matches_.push_back({residual_m, strain});
  if (matches_.size() > kMatches) matches_.pop_front();
}

double InputHealth::median_of(double Match::*figure) const {
  std::vector<double> values;
  for (const Match& match : matches_) values.push_back(match.*figure);
  return median(std::move(values));
}

bool InputHealth::contradicted() const {
  const auto strained = [](const Match& m) { return m.strain > kLargeStrain; };
  return matches_.size() >= kFewestMatches &&
         std::count_if(matches_.begin(), matches_.end(), strained) >= kStrainedMatches;
}

std::string InputHealth::problem() const {
  if (empty_ >= kEmptyFrames) return "depth frames hold hardly a return";
  if (matches_.size() < kFewestMatches) return "";
  if (contradicted())
    return fmt::format(
        "depth and IMU contradict each other ({:.1f} times what their noise explains): check T_imu_sensor, the "
        "stamps of both and the intrinsics",
        median_of(&Match::strain));
  const double residual_m = median_of(&Match::residual_m);
  if (residual_m < kLargeResidual) return "";
  return fmt::format("frames never fit each other well ({:.0f} mm): check the intrinsics and depth scale",
                     1e3 * residual_m);
}

}  // namespace liloc
