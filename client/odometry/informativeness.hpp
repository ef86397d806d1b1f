#pragma once
#include <deque>

#include "common/geometry/camera.hpp"

namespace liloc {

/// Limits found on simulated offices with people and a real kitchen; a handheld walk changes the spread by
/// under 15 % from frame to frame, a hand before the lens by more than half.
/// Defaults are by hand where nothing else is said.
struct InformativenessOptions {
  double min_valid_share = 0.08;  ///< of the pixels with a return in range; fewer see nothing
  double min_sd_m = 0.05;         ///< a bare wall seen squarely spreads less
  double near_m = 0.6;            ///< a body this close ...
  double max_near_share = 0.6;    ///< ... over so much of the valid pixels fills the view
  double sudden_share = 0.40;     ///< change against the recent median that counts as spike or drop ...
  double sudden_m = 0.15;         ///< ... and exceeds so much: a bare room spreads little ...
  double sudden_deviations = 5;   ///< ... if it also exceeds so many robust deviations of the recent values
  int window = 5;                 ///< recent informative frames; more would call a steady turn sudden
  int accept_after = 4;           ///< frames at a new level after which it is the normal one
};

enum class FrameFault { none, too_few_points, covered, flat, spike, drop };

struct FrameSpread {
  FrameFault fault = FrameFault::none;
  double sd_m = 0;         ///< standard deviation of depth (the paper's SD_depth)
  double valid_share = 0;  ///< of the pixels
  double near_share = 0;   ///< of the valid pixels

  [[nodiscard]] bool informative() const { return fault == FrameFault::none; }
};

[[nodiscard]] const char* name_of(FrameFault fault);

/// Paper, section 5.3: frames whose depth spread suddenly rises or falls say nothing about where the device is.
/// The limits adapt to the recent frames, so that a slow change of scene passes.
class Informativeness {
 public:
  explicit Informativeness(const InformativenessOptions& options = {}) : options_(options) {}
  [[nodiscard]] FrameSpread judge(const DepthImage& image, const Camera& camera, double min_range_m,
                                  double max_range_m);

 private:
  [[nodiscard]] FrameFault compare(double sd_m) const;

  InformativenessOptions options_;
  std::deque<double> recent_;   ///< spreads of informative frames
  std::deque<double> outside_;  ///< spreads of the current run of sudden ones
};

}  // namespace liloc
