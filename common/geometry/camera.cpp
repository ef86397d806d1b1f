#include "common/geometry/camera.hpp"

#include <cmath>

namespace liloc {
namespace {

constexpr int kLargestSide = 8192;  // no depth camera has as many pixels; by hand

bool positive(double value) {
  return std::isfinite(value) && value > 0;
}

}  // namespace

Result<Camera> Camera::validated(std::string_view what) const {
  if (width < 1 || width > kLargestSide)
    return fail("{}.width is {}; must be 1..{}", what, width, kLargestSide);
  if (height < 1 || height > kLargestSide)
    return fail("{}.height is {}; must be 1..{}", what, height, kLargestSide);
  if (!positive(fx)) return fail("{}.fx is {}; a focal length is positive (pixels)", what, fx);
  if (!positive(fy)) return fail("{}.fy is {}; a focal length is positive (pixels)", what, fy);
  if (!std::isfinite(cx) || cx < -width || cx > 2.0 * width)
    return fail("{}.cx is {}; must lie near the image of width {}", what, cx, width);
  if (!std::isfinite(cy) || cy < -height || cy > 2.0 * height)
    return fail("{}.cy is {}; must lie near the image of height {}", what, cy, height);
  if (!positive(depth_scale_m) || depth_scale_m > 1.0)
    return fail("{}.depth_scale is {}; give metres per unit, e.g. 0.001", what, depth_scale_m);
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
