#include "client/odometry/informativeness.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/quantile.hpp"

namespace liloc {
namespace {

constexpr int kStep = 4;  // every fourth pixel in both axes: 1200 of 320x240 give the spread to 1 %; by hand

FrameSpread measure(const DepthImage& image, const Camera& camera, double min_range_m, double max_range_m,
                    double near_m) {
  double count = 0, valid = 0, near = 0, sum = 0, squares = 0;
  for (int v = 0; v < image.height; v += kStep)
    for (int u = 0; u < image.width; u += kStep) {
      count += 1;
      const double z = image.at(u, v) * camera.depth_scale_m;
      if (z <= 0 || z > max_range_m) continue;
      if (z < near_m) near += 1;
      valid += 1;
      if (z < min_range_m) continue;
      sum += z;
      squares += z * z;
    }
  FrameSpread spread;
  spread.valid_share = count > 0 ? valid / count : 0;
  if (valid == 0) return spread;
  spread.near_share = near / valid;
  const double mean = sum / valid;
  spread.sd_m = std::sqrt(std::max(0.0, squares / valid - mean * mean));
  return spread;
}

}  // namespace

const char* name_of(FrameFault fault) {
  switch (fault) {
    case FrameFault::none:
      return "none";
    case FrameFault::too_few_points:
      return "too few points";
    case FrameFault::covered:
      return "covered";
    case FrameFault::flat:
      return "flat";
    case FrameFault::spike:
      return "spike";
    case FrameFault::drop:
      return "drop";
  }
  return "unknown";
}

FrameFault Informativeness::compare(double sd_m) const {
  if (static_cast<int>(recent_.size()) < 3) return FrameFault::none;
  const double usual = median(std::vector<double>(recent_.begin(), recent_.end()));
  std::vector<double> off;
  for (const double s : recent_) off.push_back(std::abs(s - usual));
  const double limit = std::max({options_.sudden_share * usual, options_.sudden_m,
                                 options_.sudden_deviations * 1.4826 * median(std::move(off))});
  if (sd_m > usual + limit) return FrameFault::spike;
  return sd_m < usual - limit ? FrameFault::drop : FrameFault::none;
}

FrameSpread Informativeness::judge(const DepthImage& image, const Camera& camera, double min_range_m,
                                   double max_range_m) {
  FrameSpread spread = measure(image, camera, min_range_m, max_range_m, options_.near_m);
  if (spread.valid_share < options_.min_valid_share)
    spread.fault = FrameFault::too_few_points;
  else if (spread.near_share > options_.max_near_share)
    spread.fault = FrameFault::covered;
  else if (spread.sd_m < options_.min_sd_m)
    spread.fault = FrameFault::flat;
  else
    spread.fault = compare(spread.sd_m);

  if (spread.fault == FrameFault::spike || spread.fault == FrameFault::drop) {
    outside_.push_back(spread.sd_m);
    if (static_cast<int>(outside_.size()) < options_.accept_after) return spread;
    recent_ = std::exchange(outside_, {});  // the scene is another one now
    spread.fault = FrameFault::none;
    return spread;
  }
  outside_.clear();
  if (!spread.informative()) {
    recent_.clear();  // behind the hand or the person the scene goes on changing
    return spread;
  }
  recent_.push_back(spread.sd_m);
  if (static_cast<int>(recent_.size()) > options_.window) recent_.pop_front();
  return spread;
}

}  // namespace liloc
