#include "client/engine/device_motion.hpp"

#include "client/odometry/image_thinning.hpp"
#include "common/base/log.hpp"
#include "common/geometry/depth.hpp"

namespace liloc {
namespace {

// Share that the scene shows of a rotation to compare a gyro with; by hand.
constexpr double kSeenRotation = 0.5;
constexpr std::size_t kFewestSurfels = 60;  // a frame with fewer cannot be matched; by hand

OdometryOptions odometry_options(const EngineOptions& o, int thinning) {
  OdometryOptions options;
  options.method = o.T_imu_sensor ? o.local : LocalMethod::cloud;
  options.camera = thinned(o.camera, thinning);
  options.max_range_m = o.max_range_m;
  options.T_imu_sensor = o.T_imu_sensor;
  options.cell_m = 2 * o.voxel_size_m;
  options.seed = o.seed;
  return options;
}

}  // namespace

Result<Cloud> DepthFrame::cloud(const Camera& camera, const EngineOptions& options) const {
  if (points != nullptr) return *points;
  return depth_to_cloud(image, camera,
                        {.min_range_m = options.min_range_m, .max_range_m = options.max_range_m});
}

DeviceMotion::DeviceMotion(const EngineOptions& options)
    : options_(options),
      thinning_(thinning_for(options.camera)),
      odometry_(odometry_options(options, thinning_)) {
  if (options.T_imu_sensor) imu_.emplace(ImuTrackOptions{.still_seconds = options.still_seconds});
  if (options.local == LocalMethod::external)
    external_.emplace(ExternalOdometryOptions{.T_base_sensor = options.T_base_sensor});
  else if (!imu_ && options.local != LocalMethod::cloud)
    log::warning("local registration without an IMU: the cloud method is used instead");
}

Status DeviceMotion::add(const ImuSample& sample) {
  if (!imu_) return fail("{}: IMU sample without T_imu_sensor: set it in the options", options_.client_id);
  return imu_->add(sample);
}

Status DeviceMotion::add(const OdometrySample& sample) {
  if (!external_)
    return fail("{}: odometry from outside, but the local method is another; set it to external",
                options_.client_id);
  return external_->add(sample);
}

Placed DeviceMotion::place_external(StampNs stamp_ns, const FrameSpread& spread) {
  Placed placed;
  placed.step = external_->step(stamp_ns);
  placed.informative = spread.informative() && external_->placed();
  return placed;
}

Result<Placed> DeviceMotion::place(const DepthFrame& frame, const FrameSpread& spread) {
  if (external_) return place_external(frame.image.stamp_ns, spread);
  const DepthImage small = thinned(frame.image, thinning_);
  const auto cloud = DepthFrame{small, frame.points}.cloud(thinned(options_.camera, thinning_), options_);
  if (!cloud) return tl::unexpected(cloud.error());
  const std::vector<Surfel> surfels =
      extract_surfels(*cloud, Eigen::Vector3f::Zero(), {.size_m = 2 * options_.voxel_size_m});
  const bool enough = surfels.size() >= kFewestSurfels;
  // A spike or drop is a reason not to ask the server; whether the frame fits the map the odometry judges
  // itself.
  const bool matchable =
      enough && spread.fault != FrameFault::covered && spread.fault != FrameFault::too_few_points;
  Placed placed;
  placed.informative = spread.informative() && enough;
  placed.step = odometry_.step(small, surfels, matchable, believed());
  placed.misfit = placed.informative && placed.step.source == PoseSource::guess;
  return placed;
}

/// What registration measured from one frame to the next counts alone: not guesses, nor who may follow
/// somebody.
bool DeviceMotion::judge_imu(StampNs stamp_ns, const Placed& placed, bool contradicted) {
  if (!imu_) return false;
  const OdometryStep& step = placed.step;
  const bool measured = !external_ && step.overlap > 0 && step.converged && !step.doubtful &&
                        !step.discontinuous && step.observed.head<3>().minCoeff() > kSeenRotation;
  std::optional<Pose> T_odom_imu;
  if (measured) T_odom_imu = step.T_odom_sensor * options_.T_imu_sensor->inverse();
  const bool was_believed = believed() != nullptr;
  imu_->saw(stamp_ns, T_odom_imu, placed.misfit);
  if (contradicted) imu_->strained();
  return was_believed && believed() == nullptr;
}

void DeviceMotion::mark() {
  if (external_)
    external_->mark();
  else
    odometry_.mark();
}

void DeviceMotion::clock_set(StampNs by_ns) {
  odometry_.clock_set();
  if (external_) external_->frames_clock_set();
  if (imu_) imu_->frames_clock_set(by_ns);
}

std::string DeviceMotion::problem() const {
  if (external_)
    if (std::string problem = external_->problem(); !problem.empty()) return problem;
  if (!placed()) return "no odometry for the newest frame";
  return imu_ ? imu_->problem() : "";
}

}  // namespace liloc
