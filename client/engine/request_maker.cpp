#include "client/engine/request_maker.hpp"

#include <algorithm>
#include <cmath>

#include "client/engine/byte_budget.hpp"
#include "client/engine/submap.hpp"
#include "common/geometry/voxel.hpp"

namespace liloc {
namespace {

// A message holds 256; older ones of a long silence are left out; by hand.
constexpr std::size_t kMostLocalPoses = 250;
constexpr std::size_t kLpcPoints = 4000;  // 8 to 9 kB at 0.05 m; by hand, DECISIONS.md
// Since a surface was seen, where odometry is sure of itself; by hand.
constexpr StampNs kSubmapAge = from_ms(10'000);
constexpr std::size_t kSubmapPoints = 2000;      // about 4 kB at 0.05 m; by hand
constexpr std::size_t kFewestSubmapPoints = 60;  // fewer tell nothing; by hand
// By hand: 1.5 cm and 0.2 degrees lost, DECISIONS.md.
constexpr double kSteadySdM = 0.01, kSteadySdRad = radians(0.4);  // of the motion between two requests
// Clocks; scale of path and turn; by hand.
constexpr double kOdomSdM = 0.002, kOdomSdRad = 0.001, kOdomSdShare = 0.005;

/// Finer voxels of the same surfaces are more: with fewer points they would hang in the air.
std::size_t points_at(double voxel_size_m, std::size_t at_5_cm) {
  const double finer = std::max(1.0, 0.05 / voxel_size_m);
  return std::min(kMaxCodecPoints, static_cast<std::size_t>(finer * finer * static_cast<double>(at_5_cm)));
}

}  // namespace

void RequestMaker::travelled(StampNs stamp_ns, const OdometryStep& step, bool informative) {
  if (!segment_ || step.segment != segment_->last.segment) {
    segment_ = Segment{};
  } else {
    segment_->path_m += distance_m(step.T_odom_sensor, segment_->last.T_odom_sensor);
    segment_->turned_rad += angle_between_rad(step.T_odom_sensor, segment_->last.T_odom_sensor);
  }
  segment_->last = step;
  std::vector<LocalPose>& path = segment_->path;
  if (path.size() >= kMostLocalPoses) path.erase(path.begin());
  path.push_back({stamp_ns, step.T_odom_sensor, informative});
}

MotionSd RequestMaker::motion_sd() const {
  if (!segment_) return {kOdomSdRad, kOdomSdM};
  return {std::hypot(kOdomSdRad, kOdomSdShare * segment_->turned_rad, segment_->last.sd_rad),
          std::hypot(kOdomSdM, kOdomSdShare * segment_->path_m, segment_->last.sd_m)};
}

void RequestMaker::add_surroundings(const LocalMap& surroundings, StampNs since_ns,
                                    SpotRequest& request) const {
  const Cloud standing = surroundings.standing(since_ns, request.stamp_ns);
  const auto thinned = [&](std::size_t most) {
    Cloud extra = outside_view(standing, request.T_odom_sensor, request.view, most);
    return extra.size() < kFewestSubmapPoints ? Cloud{} : extra;
  };
  const std::size_t left = options_.request_bytes - request.lpc.bytes.size();
  auto extra = encode_within(left, points_at(options_.voxel_size_m, kSubmapPoints),
                             {.codec = request.lpc.codec, .voxel_size_m = 2 * options_.voxel_size_m}, thinned);
  if (extra) request.extra = std::move(*extra);  // otherwise the frame says it all
}

Result<SpotRequest> RequestMaker::make(const Cloud& cloud_sensor, const LocalMap& surroundings,
                                       const ImuTrack* imu, bool located) {
  const auto thinned = [&](std::size_t most) {
    return voxel_downsample(cloud_sensor, options_.voxel_size_m, most);
  };
  auto lpc = encode_within(options_.request_bytes, points_at(options_.voxel_size_m, kLpcPoints),
                           {.codec = options_.codec, .voxel_size_m = options_.voxel_size_m}, thinned);
  if (!lpc) return tl::unexpected(lpc.error());
  SpotRequest r;
  r.client_id = options_.client_id;
  r.seq = next_seq_++;
  r.stamp_ns = segment_->path.back().stamp_ns;
  r.odom_segment = segment_->last.segment;
  r.T_odom_sensor = segment_->last.T_odom_sensor;
  const MotionSd sd = motion_sd();
  r.odom_sd_rad = sd.rad;
  r.odom_sd_m = sd.m;
  r.local_poses = std::exchange(segment_->path, {});
  r.lpc = std::move(*lpc);
  r.voxel_size_m = options_.voxel_size_m;
  r.view = {options_.camera, options_.min_range_m, options_.max_range_m};
  if (imu != nullptr) {
    const auto up_imu = imu->up(r.stamp_ns);
    if (up_imu) r.up_sensor = options_.T_imu_sensor->linear().transpose() * *up_imu;
    r.up_sd_rad = imu->up_sd_rad();
  }
  r.cold = options_.cold;
  if (r.odom_sd_m > kSteadySdM || r.odom_sd_rad > kSteadySdRad) segment_->unsteady_ns = r.stamp_ns;
  const StampNs oldest_ns = r.stamp_ns - kSubmapAge;
  if (options_.submap && !options_.cold)
    add_surroundings(surroundings, located ? std::max(oldest_ns, segment_->unsteady_ns) : oldest_ns, r);
  segment_->path_m = segment_->turned_rad = 0;
  return r;
}

}  // namespace liloc
