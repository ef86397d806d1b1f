#include "common/geometry/camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace liloc {
namespace {

// A pinhole image is hardly wider than that; a long lens on a short side (a LiDAR of few rows) stays above the
// least.
constexpr double kWidest_deg = 170, kNarrowest_deg = 1;
// The finest scale that reaches half a metre in 16 bits, and a tenth of a metre: no sensor is coarser.
constexpr double kFinestScale_m = 1e-5, kCoarsestScale_m = 0.1;

double view_deg(double pixels, double focal) {
  return 2 * std::atan(pixels / (2 * focal)) * 180 / std::numbers::pi;
}

/// By the angle that it makes of a side; of the narrowest by the image's longer side, as some have few rows.
Status check_focal(std::string_view what, const char* name, double focal, int side, int longer_side) {
  if (!std::isfinite(focal) || focal <= 0)
    return fail("{}.{} is {}; a focal length is positive (pixels)", what, name, focal);
  if (view_deg(side, focal) > kWidest_deg || view_deg(longer_side, focal) < kNarrowest_deg)
    return fail(
        "{}.{} is {}: {} pixels would see {:.3g} deg, a depth sensor sees {}..{}; give it in pixels of this "
        "image size",
        what, name, focal, side, view_deg(side, focal), kNarrowest_deg, kWidest_deg);
  return {};
}

}  // namespace

Result<Camera> Camera::validated(std::string_view what) const {
  if (width < 1 || width > kLargestSide)
    return fail("{}.width is {}; must be 1..{}", what, width, kLargestSide);
  if (height < 1 || height > kLargestSide)
    return fail("{}.height is {}; must be 1..{}", what, height, kLargestSide);
  for (const Status& focal : {check_focal(what, "fx", fx, width, std::max(width, height)),
                              check_focal(what, "fy", fy, height, std::max(width, height))})
    if (!focal) return tl::unexpected(focal.error());
  if (!std::isfinite(cx) || cx < -width || cx > 2.0 * width)
    return fail("{}.cx is {}; must lie near the image of width {}", what, cx, width);
  if (!std::isfinite(cy) || cy < -height || cy > 2.0 * height)
    return fail("{}.cy is {}; must lie near the image of height {}", what, cy, height);
  if (!(depth_scale_m >= kFinestScale_m && depth_scale_m <= kCoarsestScale_m))
    return fail("{}.depth_scale is {}; give metres per unit in {}..{}, e.g. 0.001", what, depth_scale_m,
                kFinestScale_m, kCoarsestScale_m);
  return *this;
}

Camera shrunk(const Camera& camera, int factor) {
  Camera small = camera;
  const double f = factor;
  small.width = (camera.width + factor - 1) / factor;
  small.height = (camera.height + factor - 1) / factor;
  small.fx /= f;
  small.fy /= f;
  small.cx = (camera.cx + 0.5) / f - 0.5;
  small.cy = (camera.cy + 0.5) / f - 0.5;
  return small;
}

}  // namespace liloc
