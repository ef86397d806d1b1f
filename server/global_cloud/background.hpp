#pragma once
#include <cstdint>
#include <vector>

#include "common/geometry/camera.hpp"

namespace liloc {

struct BackgroundOptions {
  double settle_seconds = 2.0;  ///< what stands still for so long is part of the room (again)
  double tolerance_m = 0.06;    ///< depths this close, plus 1 % of the depth, are the same surface
};

/// What moves before a ceiling LiDAR. The LiDAR stands still, so each pixel has a history of its own: a return
/// nearer than the surface behind it belongs to something that came by, until it has stood there for a while; a
/// farther one shows that the old surface is gone. Not thread-safe.
class Background {
 public:
  Background(const Camera& camera, const BackgroundOptions& options);

  /// Learns from the next frame (rising stamps) and returns it with everything that moves taken out (0), and a rim
  /// of one pixel around it. The image has the camera's size.
  [[nodiscard]] DepthImage without_moving(const DepthImage& image);

 private:
  struct Pixel {
    std::uint16_t surface = 0, candidate = 0;  ///< units; 0: not seen yet
    float candidate_since_s = 0;
  };
  [[nodiscard]] bool moving(Pixel* pixel, std::uint16_t units, float now_s) const;

  const BackgroundOptions options_;
  const double scale_m_;
  StampNs first_ns_ = 0;
  std::vector<Pixel> pixels_;
};

}  // namespace liloc
