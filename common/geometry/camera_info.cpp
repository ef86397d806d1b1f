#include "common/geometry/camera_info.hpp"

#include <algorithm>

namespace liloc {
namespace {

constexpr std::uint32_t kMostBinning = 16;  // of sensors; by hand

/// Of the whole rectified image.
Result<Camera> intrinsics_of(const CameraInfo& info) {
  const int width = static_cast<int>(info.width), height = static_cast<int>(info.height);
  const auto& k = info.k;
  const auto& p = info.p;
  if (p[0] != 0) {
    if (p[1] != 0 || p[4] != 0 || p[8] != 0 || p[9] != 0 || p[10] != 1)
      return fail("p is not [fx 0 cx tx; 0 fy cy ty; 0 0 1 0]; publish the intrinsics of the rectified image");
    return Camera{width, height, p[0], p[5], p[2], p[6]};
  }
  if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1)
    return fail("k is not [fx 0 cx; 0 fy cy; 0 0 1]; publish the intrinsics of the rectified image");
  return Camera{width, height, k[0], k[4], k[2], k[5]};
}

/// The part of the image that is sent.
Result<Camera> in_region(Camera camera, const CameraInfo& info) {
  const CameraInfo::Region& roi = info.roi;
  if (roi.width == 0 && roi.height == 0) return camera;
  if (roi.width == 0 || roi.height == 0 || std::uint64_t{roi.x_offset} + roi.width > info.width ||
      std::uint64_t{roi.y_offset} + roi.height > info.height)
    return fail("camera_info has a roi of {} x {} at {}, {}, beyond the image of {} x {}", roi.width,
                roi.height, roi.x_offset, roi.y_offset, info.width, info.height);
  camera.width = static_cast<int>(roi.width);
  camera.height = static_cast<int>(roi.height);
  camera.cx -= roi.x_offset;
  camera.cy -= roi.y_offset;
  return camera;
}

/// Of pixels that are sent as one.
Result<Camera> binned(Camera camera, const CameraInfo& info) {
  const std::uint32_t bin_x = std::max(info.binning_x, 1U), bin_y = std::max(info.binning_y, 1U);
  if (bin_x > kMostBinning || bin_y > kMostBinning)
    return fail("camera_info has binning {} x {}, must be at most {}", bin_x, bin_y, kMostBinning);
  camera.width /= static_cast<int>(bin_x);
  camera.height /= static_cast<int>(bin_y);
  camera.fx /= bin_x;
  camera.cx /= bin_x;
  camera.fy /= bin_y;
  camera.cy /= bin_y;
  return camera.validated("camera_info");
}

}  // namespace

Result<Camera> camera_of(const CameraInfo& info) {
  if (info.width < 1 || info.width > kLargestSide || info.height < 1 || info.height > kLargestSide)
    return fail("camera_info is {} x {}, must be 1..{} each way", info.width, info.height, kLargestSide);
  if (info.k[0] == 0 && info.p[0] == 0)
    return fail("camera_info has no intrinsics (k and p are 0): calibrate the camera");
  return intrinsics_of(info)
      .and_then([&](const Camera& whole) { return in_region(whole, info); })
      .and_then([&](const Camera& part) { return binned(part, info); });
}

}  // namespace liloc
