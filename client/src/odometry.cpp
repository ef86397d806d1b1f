#include "client/src/odometry.hpp"

#include <algorithm>
#include <cmath>

#include "client/src/relocate.hpp"
#include "common/base/log.hpp"

namespace liloc {
namespace {

constexpr double kAccelSd = 4.0;                        // m/s^2: how hard people push a device about
constexpr double kTurnAccelSd = 10.0;                   // rad/s^2: the same in rotation, where no gyro tells
constexpr double kImuAccelSd = 0.4;                     // m/s^2: what is left of it after the accelerometer
constexpr double kVelocitySd = 0.05;                    // m/s: of the velocity that a guess starts from
constexpr double kGyroSd = 0.004;                       // rad/s: noise, bias and timing together
constexpr double kStillSdRad = 1e-4, kStillSdM = 1e-3;  // of a frame's motion while the device stands still
constexpr double kFadingS =
    0.4;  // without an IMU a motion that is no longer seen dies away with this time constant
constexpr double kVagueM = 0.15;  // a guess worse than that does not speak for a match
constexpr double kGyroTrustRad = 0.2;
constexpr StampNs kLongestStepNs = from_ms(1000);

}  // namespace

Odometry::Odometry(const OdometryOptions& options) : options_(options), map_({.cell_m = options.cell_m}) {}

MotionGuess Odometry::guess(StampNs stamp_ns, const ImuTrack* imu) {
  const double dt = to_seconds(std::min(stamp_ns - last_ns_, kLongestStepNs));
  const double blind = to_seconds(stamp_ns - anchored_ns_);
  MotionGuess guess;
  Pose& T = guess.T_map_sensor;
  const bool gyro = imu != nullptr && imu->covers(last_ns_, stamp_ns);
  if (!gyro) {
    T.linear() = T_odom_last_.linear() * so3_exp(turn_rate_ * dt);
    T.translation() = T_odom_last_.translation() + velocity_odom_ * dt;
    guess.sd_rad = std::min(0.5, 0.003 + 0.5 * kTurnAccelSd * blind * blind);
    guess.sd_m = std::min(1.0, 0.002 + kVelocitySd * blind + 0.5 * kAccelSd * blind * blind);
    return guess;
  }
  const Pose& T_imu_sensor = *options_.T_imu_sensor;
  const Pose T_odom_imu = T_odom_last_ * T_imu_sensor.inverse();
  if (imu->still()) {
    velocity_odom_ = velocity_imu_odom_ = turn_rate_ = Eigen::Vector3d::Zero();
    return {T_odom_last_, kStillSdRad, kStillSdM};
  }
  const bool inertial = options_.method != LocalMethod::cloud || blind > 1.5 * dt;
  if (inertial) {
    const Eigen::Matrix3d R = T_odom_imu.linear();
    const InertialMotion motion = imu->motion(last_ns_, stamp_ns, R.transpose() * velocity_imu_odom_);
    T = T_odom_imu * motion.T_start_end * T_imu_sensor;
    velocity_imu_odom_ = R * motion.velocity_end_m_s;
  } else {
    const Eigen::Matrix3d R_step =
        T_imu_sensor.linear().transpose() * imu->rotation(last_ns_, stamp_ns) * T_imu_sensor.linear();
    T.linear() = T_odom_last_.linear() * R_step;
    T.translation() = T_odom_last_.translation() + velocity_odom_ * dt;
  }
  guess.sd_rad = 2e-4 + kGyroSd * blind;
  guess.sd_m = 0.002 + kVelocitySd * blind + 0.5 * (inertial ? kImuAccelSd : kAccelSd) * blind * blind;
  return guess;
}

bool Odometry::believable(const ScanMatch& match, const MotionGuess& guess, const DepthImage& image) const {
  const double turned = angle_between_rad(match.T_map_sensor, guess.T_map_sensor);
  const double moved = distance_m(match.T_map_sensor, guess.T_map_sensor);
  if (match.overlap < options_.min_overlap || turned > 0.05 + 4 * guess.sd_rad || moved > 0.05 + 4 * guess.sd_m)
    return false;
  return guess.sd_m < kVagueM || consistent(match, image);
}

bool Odometry::consistent(const ScanMatch& match, const DepthImage& image) const {
  const auto view = map_.compare(match.T_map_sensor, image, options_.camera, options_.max_range_m);
  log::debug("view: {} agree, {} seen through, {} hidden; overlap {:.2f} of {:.2f}", view.agree, view.through,
             view.hidden, match.overlap, match.paired);
  return match.overlap >= options_.min_overlap_lost && match.overlap >= 0.75 * match.paired &&
         view.refuted_share() <= options_.max_refuted_share;
}

std::optional<ScanMatch> Odometry::match(const DepthImage& image, const std::vector<Surfel>& frame,
                                         const MotionGuess& guess, OdometryStep& step) {
  const auto found = match_scan(map_, frame, guess, image.stamp_ns);
  if (found)
    log::debug(
        "match: overlap {:.2f} paired {:.2f} rmse {:.1f} mm, {} unobserved, {} iterations, {:.1f} mm {:.3f} "
        "deg "
        "from a guess good to {:.1f} mm {:.3f} deg, map {}",
        found->overlap, found->paired, 1e3 * found->rmse_m, found->unobserved, found->iterations,
        1e3 * distance_m(found->T_map_sensor, guess.T_map_sensor),
        degrees(angle_between_rad(found->T_map_sensor, guess.T_map_sensor)), 1e3 * guess.sd_m,
        degrees(guess.sd_rad), map_.size());
  if (found && believable(*found, guess, image)) {
    step.method = options_.method == LocalMethod::inertial ? "inertial" : "icp";
    return *found;
  }
  if (image.stamp_ns - recovered_ns_ < options_.recover_ns) return std::nullopt;
  recovered_ns_ = image.stamp_ns;
  for (const ScanMatch& candidate : relocate(map_, frame, image.stamp_ns, options_.seed)) {
    // The gyro cannot be off by much, whatever the features say.
    const double turned = angle_between_rad(candidate.T_map_sensor, guess.T_map_sensor);
    if (options_.T_imu_sensor && turned > kGyroTrustRad) continue;
    if (!consistent(candidate, image)) continue;
    step.method = "ransac";
    return candidate;
  }
  return std::nullopt;
}

void Odometry::accept(const ScanMatch& match, StampNs stamp_ns, ImuTrack* imu, OdometryStep& step) {
  const double dt = to_seconds(stamp_ns - last_ns_);
  const bool steady = anchored_ns_ == last_ns_;
  step.T_odom_sensor = match.T_map_sensor;
  step.overlap = match.overlap;
  const Matrix6d covariance = match.information.inverse();
  step.sd_rad = std::sqrt(covariance.diagonal().head<3>().maxCoeff());
  step.sd_m = std::sqrt(covariance.diagonal().tail<3>().maxCoeff());
  if (steady) {
    const Eigen::Matrix3d R_step = T_odom_last_.linear().transpose() * match.T_map_sensor.linear();
    if (imu != nullptr)
      imu->observe_rotation(last_ns_, stamp_ns, [&] {
        const Eigen::Matrix3d& R = options_.T_imu_sensor->linear();
        return Eigen::Matrix3d(R * R_step * R.transpose());
      }());
    turn_rate_ = so3_log(R_step) / dt;
    velocity_odom_ = (match.T_map_sensor.translation() - T_odom_last_.translation()) / dt;
  }
  if (options_.T_imu_sensor) {  // fed back to Algorithm 1: mean velocity of the IMU over the step
    const Pose T_sensor_imu = options_.T_imu_sensor->inverse();
    const Eigen::Vector3d mean =
        ((match.T_map_sensor * T_sensor_imu).translation() - (T_odom_last_ * T_sensor_imu).translation()) / dt;
    if (steady) velocity_imu_odom_ = mean;
  }
  anchored_ns_ = stamp_ns;
  unmatched_ns_ = 0;
}

void Odometry::reckon(const MotionGuess& guess, StampNs stamp_ns, OdometryStep& step) {
  step.method = "inertial";
  step.T_odom_sensor = guess.T_map_sensor;
  step.sd_rad = guess.sd_rad;
  step.sd_m = guess.sd_m;
  anchored_ns_ = stamp_ns;
}

void Odometry::coast(const MotionGuess& guess, StampNs stamp_ns, bool usable, OdometryStep& step) {
  step.method = "guess";
  step.converged = false;
  step.T_odom_sensor = guess.T_map_sensor;
  step.sd_rad = guess.sd_rad;
  step.sd_m = guess.sd_m;
  const StampNs blind = stamp_ns - anchored_ns_,
                longest = options_.T_imu_sensor ? options_.coast_ns : options_.coast_ns / 2;
  const double fading = options_.T_imu_sensor ? 1.0 : std::exp(-to_seconds(stamp_ns - last_ns_) / kFadingS);
  velocity_odom_ *= blind > longest ? 0.0 : fading;
  velocity_imu_odom_ *= blind > longest ? 0.0 : 1.0;
  turn_rate_ *= blind > longest ? 0.0 : fading;
  if (!usable || map_.size() == 0) return;
  if (unmatched_ns_ == 0) unmatched_ns_ = stamp_ns;
  if (blind > longest && stamp_ns - unmatched_ns_ >= options_.give_up_ns) start_segment(stamp_ns);
}

void Odometry::start_segment(StampNs stamp_ns) {
  log::warning("odometry lost for {:.1f} s: a new segment starts", to_seconds(stamp_ns - anchored_ns_));
  map_.clear();
  ++segment_;
  velocity_odom_ = velocity_imu_odom_ = turn_rate_ = Eigen::Vector3d::Zero();
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
  const StampNs stamp = image.stamp_ns;
  const bool empty_map = map_.size() == 0;
  if (!started_) {
    started_ = true;
    step.method = "first";
    step.converged = usable;
    anchored_ns_ = stamp;
  } else {
    const MotionGuess expected = guess(stamp, imu);
    std::optional<ScanMatch> matched;
    if (usable && !empty_map && options_.method != LocalMethod::dead_reckoning)
      matched = match(image, frame, expected, step);
    if (matched) {
      accept(*matched, stamp, imu, step);
    } else if (options_.method == LocalMethod::dead_reckoning) {
      reckon(expected, stamp, step);
    } else {
      coast(expected, stamp, usable, step);
      if (map_.size() == 0 && usable) anchored_ns_ = stamp, unmatched_ns_ = 0;
    }
  }
  if (usable && (step.converged || map_.size() == 0)) remember(image, frame, step.T_odom_sensor);
  step.segment = segment_;
  T_odom_last_ = step.T_odom_sensor;
  last_ns_ = stamp;
  return step;
}

}  // namespace liloc
