#include "client/src/odometry.hpp"

#include <algorithm>
#include <cmath>

#include "client/src/relocate.hpp"
#include "common/base/log.hpp"

namespace liloc {
namespace {

constexpr double kVagueM = 0.15;                       // a guess worse than that does not speak for a match
constexpr double kVagueRad = 0.1, kPoorOverlap = 0.8;  // one turned by more may lead to a wrong match
constexpr double kReachM = 0.3, kReachSpeed = 2;  // m/s: nobody carries a device off faster while it is blind
constexpr double kGyroTrustRad = 0.2;             // the gyro cannot be off by more over a bridged stretch

}  // namespace

Odometry::Odometry(const OdometryOptions& options)
    : options_(options),
      map_({.cell_m = options.cell_m}),
      motion_(options.T_imu_sensor, options.method == LocalMethod::cloud ? InertialMethod::preintegration
                                                                         : InertialMethod::algorithm1) {}

bool Odometry::believable(const ScanMatch& match, const MotionGuess& guess, const DepthImage& image) const {
  const double turned = angle_between_rad(match.T_map_sensor, guess.T_map_sensor);
  const double moved = distance_m(match.T_map_sensor, guess.T_map_sensor);
  if (match.overlap < options_.min_overlap || turned > 0.05 + 4 * guess.sd_rad() ||
      moved > 0.05 + 4 * guess.sd_m())
    return false;
  return guess.sd_m() < kVagueM || consistent(match, image);
}

bool Odometry::consistent(const ScanMatch& match, const DepthImage& image) const {
  const auto view = map_.compare(match.T_map_sensor, image, options_.camera, options_.max_range_m);
  log::debug("view: {} agree, {} seen through, {} hidden; overlap {:.2f} of {:.2f}", view.agree, view.through,
             view.hidden, match.overlap, match.paired);
  return match.overlap >= options_.min_overlap_lost && match.overlap >= 0.75 * match.paired &&
         view.refuted_share() <= options_.max_refuted_share;
}

bool Odometry::unhidden(const ScanMatch& match, const DepthImage& image) const {
  const auto view = map_.compare(match.T_map_sensor, image, options_.camera, options_.max_range_m);
  return view.hidden <= view.agree + view.through;
}

std::optional<ScanMatch> Odometry::match(const DepthImage& image, const std::vector<Surfel>& frame,
                                         const MotionGuess& guess, OdometryStep& step) {
  auto found = match_scan(map_, frame, guess, image.stamp_ns);
  if (found && guess.sd_rad() > kVagueRad && found->overlap < kPoorOverlap)
    for (ScanMatch& wide : match_widely(map_, frame, guess, image.stamp_ns))
      if (believable(wide, guess, image) && unhidden(wide, image)) {
        found = std::move(wide);
        break;
      }
  if (found)
    log::debug(
        "match: overlap {:.2f} paired {:.2f} rmse {:.1f} mm, {} unobserved, {} iterations, {:.1f} mm {:.3f} "
        "deg "
        "from a guess good to {:.1f} mm {:.3f} deg, map {}",
        found->overlap, found->paired, 1e3 * found->rmse_m, found->unobserved, found->iterations,
        1e3 * distance_m(found->T_map_sensor, guess.T_map_sensor),
        degrees(angle_between_rad(found->T_map_sensor, guess.T_map_sensor)), 1e3 * guess.sd_m(),
        degrees(guess.sd_rad()), map_.size());
  if (found && believable(*found, guess, image)) {
    step.method = options_.method == LocalMethod::inertial ? "inertial" : "icp";
    return *found;
  }
  // The inertial method does without features, as the paper's does.
  if (options_.method == LocalMethod::inertial || image.stamp_ns - recovered_ns_ < options_.recover_ns)
    return std::nullopt;
  recovered_ns_ = image.stamp_ns;
  const double reach_m = kReachM + kReachSpeed * to_seconds(image.stamp_ns - anchored_ns_);
  for (const ScanMatch& candidate : relocate(map_, frame, image.stamp_ns, options_.seed)) {
    const double turned = angle_between_rad(candidate.T_map_sensor, guess.T_map_sensor);
    if (options_.T_imu_sensor && turned > kGyroTrustRad) continue;
    if (distance_m(candidate.T_map_sensor, guess.T_map_sensor) > reach_m) continue;
    if (!consistent(candidate, image)) continue;
    step.method = "ransac";
    return candidate;
  }
  return std::nullopt;
}

void Odometry::accept(const ScanMatch& match, const FrameStep& from, const MotionGuess& guess, ImuTrack* imu,
                      OdometryStep& step) {
  step.T_odom_sensor = match.T_map_sensor;
  step.overlap = match.overlap;
  step.residual_m = match.rmse_m;
  const Eigen::Matrix3d R = match.T_map_sensor.linear();
  step.observed.head<3>() = (R.transpose() * match.observed.topLeftCorner<3, 3>() * R).diagonal();
  step.observed.tail<3>() = (R.transpose() * match.observed.bottomRightCorner<3, 3>() * R).diagonal();
  const Matrix6d covariance = match.information.inverse();
  step.sd_rad = std::sqrt(covariance.diagonal().head<3>().maxCoeff());
  step.sd_m = std::sqrt(covariance.diagonal().tail<3>().maxCoeff());
  step.jumped =
      from.anchored_ns != from.from_ns && distance_m(match.T_map_sensor, guess.T_map_sensor) > options_.jump_m;
  unmatched_ns_ = 0;
  anchored_ns_ = from.to_ns;
  if (step.method == "ransac") return motion_.relocated(match.T_map_sensor);
  motion_.learn(from, guess, {match.T_map_sensor, covariance});
  if (motion_.filter()) step.strain = motion_.filter()->strain();
  if (imu == nullptr || from.anchored_ns != from.from_ns) return;
  const Eigen::Matrix3d& R_imu_sensor = options_.T_imu_sensor->linear();
  const Eigen::Matrix3d R_step = from.T_odom_from.linear().transpose() * match.T_map_sensor.linear();
  imu->observe_rotation(from.from_ns, from.to_ns, R_imu_sensor * R_step * R_imu_sensor.transpose());
}

void Odometry::reckon(const MotionGuess& guess, StampNs stamp_ns, OdometryStep& step) {
  step.method = "inertial";
  step.T_odom_sensor = guess.T_map_sensor;
  step.sd_rad = guess.sd_rad();
  step.sd_m = guess.sd_m();
  anchored_ns_ = stamp_ns;
}

void Odometry::coast(const MotionGuess& guess, const FrameStep& from, bool usable, OdometryStep& step) {
  step.method = "guess";
  step.converged = false;
  step.T_odom_sensor = guess.T_map_sensor;
  step.sd_rad = guess.sd_rad();
  step.sd_m = guess.sd_m();
  const StampNs blind = from.to_ns - from.anchored_ns;
  const StampNs longest = options_.T_imu_sensor ? options_.coast_ns : options_.coast_ns / 2;
  if (blind > longest)
    motion_.halt();
  else
    motion_.fade(from);
  if (!usable || map_.size() == 0) return;
  if (unmatched_ns_ == 0) unmatched_ns_ = from.to_ns;
  if (blind > longest && from.to_ns - unmatched_ns_ >= options_.give_up_ns) start_segment(from.to_ns);
}

void Odometry::start_segment(StampNs stamp_ns) {
  log::warning("odometry lost for {:.1f} s: a new segment starts", to_seconds(stamp_ns - anchored_ns_));
  map_.clear();
  ++segment_;
  motion_.halt();
}

void Odometry::remember(const DepthImage& image, const std::vector<Surfel>& frame, const Pose& T_odom_sensor) {
  const bool due = image.stamp_ns - keyframe_ns_ >= options_.keyframe_ns || map_.size() == 0 ||
                   distance_m(T_odom_sensor, T_odom_keyframe_) > options_.keyframe_m ||
                   angle_between_rad(T_odom_sensor, T_odom_keyframe_) > options_.keyframe_rad;
  if (!due) return;
  map_.carve(T_odom_sensor, image, options_.camera, options_.max_range_m);
  map_.insert(T_odom_sensor, frame, image.stamp_ns);
  keyframe_ns_ = image.stamp_ns;
  T_odom_keyframe_ = T_odom_sensor;
}

OdometryStep Odometry::step(const DepthImage& image, const std::vector<Surfel>& frame, bool usable,
                            ImuTrack* imu) {
  OdometryStep step;
  if (last_ns_ == 0) {
    step.method = "first";
    step.converged = usable;
    anchored_ns_ = image.stamp_ns;
  } else {
    const FrameStep from{last_ns_, image.stamp_ns, anchored_ns_, T_odom_last_};
    const MotionGuess expected = motion_.guess(from, imu);
    // After a long time any corner may look like one of the map's.
    if (usable && map_.size() > 0 && image.stamp_ns - anchored_ns_ > options_.bridge_ns)
      start_segment(image.stamp_ns);
    std::optional<ScanMatch> matched;
    if (usable && map_.size() > 0 && options_.method != LocalMethod::dead_reckoning)
      matched = match(image, frame, expected, step);
    if (matched)
      accept(*matched, from, expected, imu, step);
    else if (options_.method == LocalMethod::dead_reckoning)
      reckon(expected, image.stamp_ns, step);
    else
      coast(expected, from, usable, step);
  }
  const bool first_of_segment = map_.size() == 0;
  if (usable && (step.converged || first_of_segment)) remember(image, frame, step.T_odom_sensor);
  if (usable && first_of_segment) {
    anchored_ns_ = image.stamp_ns;
    unmatched_ns_ = 0;
  }
  step.segment = segment_;
  T_odom_last_ = step.T_odom_sensor;
  last_ns_ = image.stamp_ns;
  return step;
}

}  // namespace liloc
