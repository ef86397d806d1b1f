#include "client/src/input_health.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace liloc {
namespace {

constexpr int kEmptyFrames = 15;
constexpr std::size_t kMatches = 60, kFewestMatches = 30;
constexpr int kStrainedMatches = 15;
constexpr double kLargeStrain = 2;  // in 33 simulated walks, calm and crowded, it never came to that
constexpr double kLargeResidual =
    0.012;  // a right calibration has 4 to 7 mm in furnished rooms, noise included

}  // namespace

void InputHealth::note(FrameFault fault, double residual_m, double strain) {
  empty_ = fault == FrameFault::too_few_points ? empty_ + 1 : 0;
  if (residual_m <= 0) return;
  strained_ = strain > kLargeStrain ? strained_ + 1 : 0;
  strain_ = strain;
  residuals_m_.push_back(residual_m);
  if (residuals_m_.size() > kMatches) residuals_m_.pop_front();
}

std::string InputHealth::problem() const {
  if (empty_ >= kEmptyFrames) return "depth frames hold hardly a return";
  if (strained_ >= kStrainedMatches)
    return fmt::format(
        "depth and IMU contradict each other ({:.0f} times what their noise explains): check T_imu_sensor, the "
        "stamps of both and the intrinsics",
        strain_);
  if (residuals_m_.size() < kFewestMatches) return "";
  std::vector<double> residuals(residuals_m_.begin(), residuals_m_.end());
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  if (*middle < kLargeResidual) return "";
  return fmt::format("frames never fit each other well ({:.0f} mm): check the intrinsics and depth scale",
                     1e3 * *middle);
}

}  // namespace liloc
