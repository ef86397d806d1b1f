#pragma once
#include <cstdint>
#include <vector>

#include "common/geometry/camera.hpp"
#include "server/global_cloud/depth_noise.hpp"
#include "server/global_cloud/layers.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct BackgroundOptions {
  double absorb_seconds = 2.0;  ///< what stands still for so long is part of the room (again)
  double tolerance_m = 0.06;    ///< depths this close, plus 1 % of the depth, are the same surface ...
  double tolerance_sigmas = 4;  ///< ... and those that the sensor's noise explains
  double forget_seconds = 1.0;  ///< a surface without any return for so long is forgotten ...
  /// ... if that is so unlikely (-ln, 1 in 1100) for how often the pixel has returns.
  double forget_surprisal = 7;
  int most_averaged = 30;       ///< frames in a pixel's running mean
  double hold_m = 0.01;         ///< means that moved by less, plus 0.3 % of the depth, are shown as they were
  double fresh_share = 0.004;   ///< so much of the image changed: the room is to be derived anew at once ...
  double small_share = 0.0005;  ///< ... or with the next renewal
};

enum class Change { none, small, large };

/// The room before one ceiling LiDAR without what moves. The LiDAR stands still, so each pixel has a history of
/// its own: a return nearer than its surface, or where there was none, belongs to something that came by, until
/// it has stood there for a while; two farther ones show that the old surface is gone. A surface of few frames
/// that something nearer hides may be the same thing on its way: it is not shown until it is seen for longer. A
/// return that continues a neighbour's surface where there was none is more of that. Surfaces are running
/// means, so their noise shrinks with time. A sensor that often has no return keeps its surfaces for longer.
/// Not thread-safe.
class Background {
 public:
  /// `known`: what was learned of the sensor before.
  Background(const Camera& camera, const BackgroundOptions& options, const DepthNoise& known = {});

  /// Learns from the next frame (rising stamps, the camera's size) and takes it apart.
  [[nodiscard]] Layers learn(const DepthImage& image);

  /// How the sensor errs, by what has stood still so far.
  [[nodiscard]] const DepthNoise& noise() const { return meter_.noise(); }

  /// How much the surfaces have changed since the last call of `surfaces`; large also after the 3rd, 10th and
  /// 30th frame, for what the means have gained.
  [[nodiscard]] Change change() const;
  /// The surfaces as a depth image, stamped by the last frame. What only trembles is the same from image to
  /// image, so that what is derived from it need not change; it is shown anew as its mean gains frames.
  [[nodiscard]] DepthImage surfaces();

 private:
  enum class Kind : std::uint8_t { nothing, still, nearer, farther };
  struct Pixel {
    float surface = 0, candidate = 0;  ///< units; 0: not seen yet
    std::uint32_t candidate_since_ms = 0, missing_since_ms = 0;
    std::uint8_t averaged = 0, candidates = 0;
    bool missing = false;
    bool doubted = false;             ///< hidden while of few frames: not shown until it is of more
    std::uint8_t shown_averaged = 0;  ///< frames in the mean that `surfaces` showed last
    std::uint16_t shown = 0;          ///< units
    std::uint16_t missed = 0;         ///< frames since the last return
    std::uint16_t last = 0;           ///< units of the last return
    float gap = 1;                    ///< mean number of frames from return to return
  };
  // Times are milliseconds that wrap: only differences count, and a clock may be set forward by years.
  [[nodiscard]] Kind learn(std::size_t i, float units, std::uint32_t now_ms);
  [[nodiscard]] bool continues_a_neighbour(std::size_t i, float units) const;
  [[nodiscard]] Layers separated(const DepthImage& image) const;
  /// Whether a return of so many units (0: none) contradicts the surface that pixel i showed last.
  [[nodiscard]] bool gone(std::size_t i, float units) const;
  /// Whether enough of pixel i's neighbours are alike for that to be no noise.
  template <class Alike>
  [[nodiscard]] bool in_company(std::size_t i, const Alike& alike) const;
  [[nodiscard]] float tolerance_of(float units) const;
  template <class Visit>
  void for_each_around(std::size_t i, const Visit& visit) const;
  /// Takes note where a surface may be somebody who has come nearer since; once for each surface.
  void doubt(Pixel* pixel, Kind kind);
  void show(Pixel* pixel) const;
  [[nodiscard]] bool gained() const;
  void miss(Pixel* pixel, std::uint32_t now_ms);
  [[nodiscard]] float surprisal_of_missing(const Pixel& pixel) const;  ///< -ln of its chance
  void measure();  ///< takes the frame into the sensor's noise
  void replace(Pixel* pixel, float units);

  BackgroundOptions options_;
  int width_, height_;
  double scale_m_;
  StampNs last_ns_ = 0;
  std::size_t replaced_ = 0;  ///< pixels, since the surfaces were last asked for
  int frames_ = 0;
  std::vector<Pixel> pixels_;
  std::vector<Kind> kinds_;  ///< of the newest frame; what is not known to be there yet counts as nearer
  NoiseMeter meter_;
};

}  // namespace liloc
