#include "client/odometry/odometry.hpp"

#include <algorithm>
#include <cmath>

#include "client/odometry/match_check.hpp"
#include "client/odometry/relocate.hpp"
#include "common/base/limited_log.hpp"
#include "common/geometry/pose_estimate.hpp"

namespace liloc {
namespace {

// By hand, where nothing else is said.
constexpr double kWidePriorRad = 0.1, kPoorOverlap = 0.8;  // one turned by more may lead to a wrong match
constexpr double kReachM = 0.3, kReachSpeed = 2;  // m/s: nobody carries a device off faster while it is blind
constexpr double kGyroTrustRad = 0.2;             // the gyro cannot be off by more over a bridged stretch
// Of a pose that the scene showed along some axes only; by hand.
constexpr double kGuessedSdM = 0.02;
constexpr double kHeldSdRad = 0.0005, kHeldSdM = 0.001;  // of a standing device: StandingOptions::moved_m / 3
constexpr double kRivalAhead = 0.1;  // of overlap, by which a match without the IMU has to be better; by hand
// Frames that stood where a reference was taken, and that then tell it is left; by hand.
constexpr int kProven = 3;
constexpr StampNs kReferAfter = from_ms(2000);  // somebody who passes covers the view for less; by hand
// Of variances: errors of the map last, and people are not in the model; checked on 60 walks, EVIDENCE.md.
constexpr double kLastingDoubt = 4;

double largest_sd_m(const Matrix6d& covariance) {
  return std::sqrt(covariance.diagonal().tail<3>().maxCoeff());
}

}  // namespace

Odometry::Odometry(const OdometryOptions& options)
    : options_(options),
      segment_(0, options.cell_m),
      motion_(options.T_imu_sensor, options.method == LocalMethod::cloud ? InertialMethod::preintegration
                                                                         : InertialMethod::algorithm1),
      standing_(options.camera) {}

/// From the guess, or from all over its region where that is large and the frame hardly fits.
std::optional<ScanMatch> Odometry::match_near(const std::vector<Surfel>& frame, const MotionGuess& guess,
                                              const MatchCheck& check, StampNs stamp_ns) const {
  auto found = match_scan(segment_.map, frame, guess, stamp_ns);
  if (!found) return std::nullopt;
  std::optional<ScanMatch> best;
  if (check.believable(*found)) best = *found;
  if (guess.sd_rad() > kWidePriorRad && found->overlap < kPoorOverlap)
    for (const ScanMatch& wide : match_widely(segment_.map, frame, guess, stamp_ns))
      if (check.believable(wide) && check.unhidden(wide) && (!best || check.merit(wide) > check.merit(*best)))
        best = wide;
  log::debug(
      "match: {}overlap {:.2f} paired {:.2f} rmse {:.1f} mm, {} unobserved, {} iterations, {:.1f} mm {:.3f} "
      "deg from a guess good to {:.1f} mm {:.3f} deg, map {}",
      best ? "" : "not believed: ", found->overlap, found->paired, 1e3 * found->rmse_m, found->unobserved,
      found->iterations, 1e3 * distance_m(found->T_map_sensor, guess.T_map_sensor),
      degrees(angle_between_rad(found->T_map_sensor, guess.T_map_sensor)), 1e3 * guess.sd_m(),
      degrees(guess.sd_rad()), segment_.map.size());
  return best;
}

std::optional<ScanMatch> Odometry::stand(const DepthImage& image, const MotionGuess& guess) {
  if (!standing_.has_reference()) return std::nullopt;
  // Who felt the device move, or saw it, does not believe what only looks the same.
  if (guess.squared_mahalanobis(standing_.T_odom_reference()) > kChiSquareLimit) {
    ++segment_.gone;
    return std::nullopt;
  }
  const StandingCheck check = standing_.compare(image);
  log::debug(
      "standing: {}, share {:.2f}, {} tiles, known to {:.1f} mm, agree {:.2f}, moved {:.1f} mm {:.3f} deg",
      check.stands, check.share, check.tiles, 1e3 * check.sd_m, check.agree,
      1e3 * check.motion.tail<3>().norm(), degrees(check.motion.head<3>().norm()), check.explained);
  segment_.gone = check.moved ? segment_.gone + 1 : 0;
  if (!check.stands) return std::nullopt;
  // Where the view says little, a guess that felt the motion says more.
  const Pose& T_reference = standing_.T_odom_reference();
  Matrix6d turn = Matrix6d::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = T_reference.linear();
  Matrix6d held = check.information.inverse();
  held.diagonal().head<3>().array() += kHeldSdRad * kHeldSdRad;
  held.diagonal().tail<3>().array() += kHeldSdM * kHeldSdM;
  const Matrix6d seen = turn * held.inverse() * turn.transpose();
  Vector6d back;
  back << so3_log(T_reference.linear() * guess.T_map_sensor.linear().transpose()),
      T_reference.translation() - guess.T_map_sensor.translation();
  ScanMatch match;
  match.information = guess.covariance.inverse() + seen;
  const Vector6d step = match.information.ldlt().solve(seen * back);
  match.T_map_sensor.linear() = so3_exp(step.head<3>()) * guess.T_map_sensor.linear();
  match.T_map_sensor.translation() = guess.T_map_sensor.translation() + step.tail<3>();
  match.observed = Matrix6d::Identity();
  match.overlap = match.paired = check.share;
  match.stop = ScanStop::converged;
  return match;
}

/// The IMU is believed where both fit alike.
std::optional<ScanMatch> Odometry::match_rival(const DepthImage& image, const std::vector<Surfel>& frame,
                                               const MotionGuess& rival, double evidence) const {
  const MatchCheck check(segment_.map, image, rival, options_);
  auto found = match_near(frame, rival, check, image.stamp_ns);
  if (!found || !check.consistent(*found) || !check.unhidden(*found)) return std::nullopt;
  if (check.evidence(*found) < evidence + kRivalAhead) return std::nullopt;
  return found;
}

std::optional<ScanMatch> Odometry::match(const DepthImage& image, const std::vector<Surfel>& frame,
                                         const FrameStep& from, MotionGuess& guess, OdometryStep& step) {
  MatchCheck check(segment_.map, image, guess, options_);
  auto near = match_near(frame, guess, check, image.stamp_ns);
  const auto rival = motion_.rival(from, guess, !near);
  if (rival && options_.method == LocalMethod::cloud)
    if (auto other = match_rival(image, frame, *rival, near ? check.evidence(*near) : options_.min_overlap)) {
      near = other;
      guess = *rival;  // and what `check` refers to
      motion_.take_rival(from);
    }
  if (near) {
    step.source = options_.method == LocalMethod::inertial ? PoseSource::inertial : PoseSource::icp;
    step.doubtful = check.doubtful(*near);
    return near;
  }
  // The inertial method does without features, as the paper's does.
  if (options_.method == LocalMethod::inertial || image.stamp_ns - recovered_ns_ < options_.recover_ns)
    return std::nullopt;
  recovered_ns_ = image.stamp_ns;
  const double reach_m = kReachM + kReachSpeed * to_seconds(image.stamp_ns - segment_.anchored_ns);
  for (const ScanMatch& candidate : relocate(segment_.map, frame, image.stamp_ns, options_.seed)) {
    const double turned = angle_between_rad(candidate.T_map_sensor, guess.T_map_sensor);
    if (has_imu_ && turned > kGyroTrustRad) continue;
    if (distance_m(candidate.T_map_sensor, guess.T_map_sensor) > reach_m) continue;
    if (!check.consistent(candidate)) continue;
    step.source = PoseSource::ransac;
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
  const bool guessed = from.anchored_ns != from.from_ns || largest_sd_m(segment_.covariance) > kGuessedSdM;
  step.discontinuous = guessed && distance_m(match.T_map_sensor, guess.T_map_sensor) > options_.discontinuity_m;
  segment_.unmatched_ns = 0;
  segment_.anchored_ns = from.to_ns;
  const bool found = step.source == PoseSource::ransac;
  if (found)
    motion_.relocated({match.T_map_sensor, covariance});
  else
    motion_.learn(from, guess, {match.T_map_sensor, covariance});
  // A wrong step is not taken back, and who follows somebody errs the same way again.
  if (step.doubtful) segment_.slipped += guess.covariance.diagonal().cwiseSqrt();
  tell_doubt(step);
  if (found) return;
  if (motion_.filter()) step.strain = motion_.filter()->strain();
  if (imu == nullptr || from.anchored_ns != from.from_ns) return;
  const Eigen::Matrix3d& R_imu_sensor = options_.T_imu_sensor->linear();
  const Eigen::Matrix3d R_step = from.T_odom_from.linear().transpose() * match.T_map_sensor.linear();
  imu->observe_rotation(from.from_ns, from.to_ns, R_imu_sensor * R_step * R_imu_sensor.transpose());
}

void Odometry::reckon(const MotionGuess& guess, StampNs stamp_ns, OdometryStep& step) {
  step.source = PoseSource::inertial;
  step.T_odom_sensor = guess.T_map_sensor;
  tell_doubt(step);
  segment_.anchored_ns = stamp_ns;
}

void Odometry::coast(const MotionGuess& guess, const FrameStep& from, bool usable, OdometryStep& step) {
  step.source = PoseSource::guess;
  step.converged = false;
  step.T_odom_sensor = guess.T_map_sensor;
  tell_doubt(step);
  const StampNs blind = from.to_ns - from.anchored_ns;
  const StampNs longest = has_imu_ ? options_.coast_ns : options_.coast_ns / 2;
  if (blind > longest)
    motion_.halt();
  else
    motion_.fade(from);
  if (!usable || segment_.map.size() == 0) return;
  if (segment_.unmatched_ns == 0) segment_.unmatched_ns = from.to_ns;
  if (blind > longest && from.to_ns - segment_.unmatched_ns >= options_.give_up_ns) start_segment(from.to_ns);
}

void Odometry::tell_doubt(OdometryStep& step) {
  segment_.covariance = motion_.covariance();
  const Vector6d variances =
      kLastingDoubt * (segment_.marked + segment_.covariance).diagonal() + segment_.slipped.cwiseAbs2();
  step.sd_rad = std::sqrt(variances.head<3>().maxCoeff());
  step.sd_m = std::sqrt(variances.tail<3>().maxCoeff());
}

void Odometry::start_segment(StampNs stamp_ns) {
  log::limited(lost_lines_, "odometry lost for {:.1f} s: a new segment starts",
               to_seconds(stamp_ns - segment_.anchored_ns));
  begin_anew();
}

void Odometry::begin_anew() {
  segment_ = Segment(segment_.id + 1, options_.cell_m);
  standing_.forget();
  motion_.restart();
}

void Odometry::clock_set() {
  if (last_ns_ == 0) return;
  last_ns_ = recovered_ns_ = 0;
  begin_anew();
}

void Odometry::remember(const DepthImage& image, const std::vector<Surfel>& frame, const Pose& T_odom_sensor) {
  const bool due = image.stamp_ns - segment_.keyframe_ns >= options_.keyframe_ns || segment_.map.size() == 0 ||
                   distance_m(T_odom_sensor, segment_.T_odom_keyframe) > options_.keyframe_m ||
                   angle_between_rad(T_odom_sensor, segment_.T_odom_keyframe) > options_.keyframe_rad;
  if (!due) return;
  segment_.map.carve(T_odom_sensor, image, options_.camera, options_.max_range_m);
  segment_.map.insert(T_odom_sensor, frame, image.stamp_ns);
  segment_.keyframe_ns = image.stamp_ns;
  segment_.T_odom_keyframe = T_odom_sensor;
}

/// A reference stays while the device is near it: a frame in which somebody covers what shows that it stands
/// does not make a new one.
void Odometry::refer(const DepthImage& image, const OdometryStep& step) {
  standing_.next(image);
  if (step.source == PoseSource::standing) {
    segment_.stood_ns = image.stamp_ns;
    ++segment_.stood;
  }
  if (step.source == PoseSource::standing || !step.converged || step.doubtful) return;
  const bool left = segment_.gone >= (segment_.stood >= kProven ? kProven : 1);
  if (standing_.has_reference() && !left && image.stamp_ns - segment_.stood_ns <= kReferAfter) return;
  standing_.refer(step.T_odom_sensor);
  segment_.stood_ns = image.stamp_ns;
  segment_.stood = segment_.gone = 0;
}

OdometryStep Odometry::step(const DepthImage& image, const std::vector<Surfel>& frame, bool usable,
                            ImuTrack* imu) {
  OdometryStep step;
  has_imu_ = imu != nullptr;
  if (last_ns_ == 0) {
    step.source = PoseSource::first;
    step.T_odom_sensor = T_odom_last_;
    step.converged = usable;
    step.discontinuous = segment_.id > 0;  // nobody saw the way from the last segment
    segment_.anchored_ns = image.stamp_ns;
  } else {
    const FrameStep from{last_ns_, image.stamp_ns, segment_.anchored_ns, T_odom_last_};
    MotionGuess expected = motion_.guess(from, imu);
    // After a long time any corner may look like one of the map's.
    if (usable && segment_.map.size() > 0 && image.stamp_ns - segment_.anchored_ns > options_.bridge_ns)
      start_segment(image.stamp_ns);
    std::optional<ScanMatch> matched;
    if (usable && options_.method == LocalMethod::cloud) matched = stand(image, expected);
    if (matched)
      step.source = PoseSource::standing;
    else if (usable && segment_.map.size() > 0 && options_.method != LocalMethod::dead_reckoning)
      matched = match(image, frame, from, expected, step);
    if (matched)
      accept(*matched, from, expected, imu, step);
    else if (options_.method == LocalMethod::dead_reckoning)
      reckon(expected, image.stamp_ns, step);
    else
      coast(expected, from, usable, step);
  }
  const bool first_of_segment = segment_.map.size() == 0;
  if (usable && (step.converged || first_of_segment)) remember(image, frame, step.T_odom_sensor);
  if (usable && first_of_segment) {
    segment_.anchored_ns = image.stamp_ns;
    segment_.unmatched_ns = 0;
  }
  if (usable && options_.method == LocalMethod::cloud) refer(image, step);
  step.segment = segment_.id;
  T_odom_last_ = step.T_odom_sensor;
  last_ns_ = image.stamp_ns;
  return step;
}

}  // namespace liloc
