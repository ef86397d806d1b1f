#include "client/engine/engine.hpp"

#include "client/engine/input_health.hpp"
#include "client/engine/map_link.hpp"
#include "client/engine/pose_doubt.hpp"
#include "client/engine/request_maker.hpp"
#include "client/engine/request_schedule.hpp"
#include "client/inertial/imu_trust.hpp"
#include "client/odometry/external_odometry.hpp"
#include "client/odometry/image_thinning.hpp"
#include "client/odometry/informativeness.hpp"
#include "client/odometry/odometry.hpp"
#include "client/odometry/points_view.hpp"
#include "common/base/limited_log.hpp"
#include "common/base/stamp_watch.hpp"
#include "common/geometry/depth.hpp"

namespace liloc {
namespace {

constexpr int kSilentIntervals = 3;             // without an answer, the server counts as silent; by hand
constexpr StampNs kToldFor = from_ms(3000);     // that the clock was set; by hand
constexpr StampNs kClosestFrames = from_ms(1);  // no depth sensor is as quick as that
constexpr std::size_t kJudgedFrames = 3;        // judge the unit of the stamps, by their mean rise; by hand
constexpr double kSeenRotation =
    0.5;  // share that the scene shows of a rotation to compare a gyro with; by hand
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

RequestScheduleOptions schedule_options(const EngineOptions& o) {
  return {o.interval_ns, o.cold ? o.interval_ns : o.searching_interval_ns, o.reply_timeout_ns};
}

/// Where a frame was taken, and whether it can be sent.
struct Placed {
  OdometryStep step;
  bool informative = false;
};

}  // namespace

struct Engine::Impl {
  explicit Impl(EngineOptions o)
      : options(std::move(o)),
        thinning(thinning_for(options.camera)),
        odometry(odometry_options(options, thinning)),
        schedule(schedule_options(options)),
        requests(options),
        link(kSilentIntervals * options.interval_ns) {
    if (options.T_imu_sensor) imu.emplace(ImuTrackOptions{.still_seconds = options.still_seconds});
    if (options.local == LocalMethod::external)
      external.emplace(ExternalOdometryOptions{.T_base_sensor = options.T_base_sensor});
    else if (!imu && options.local != LocalMethod::cloud)
      log::warning("local registration without an IMU: the cloud method is used instead");
  }

  /// By how much the clock was set (StampWatch).
  [[nodiscard]] Result<StampNs> check(const DepthImage& image);
  void set_clock_back(StampNs by_ns);
  [[nodiscard]] std::string clock_problem() const;
  /// `points`: within the view, where the frame came as a cloud.
  [[nodiscard]] Result<FrameResult> add(const DepthImage& image, const Cloud* points);
  [[nodiscard]] Result<Placed> place(const DepthImage& image, const Cloud* points, const FrameSpread& spread);
  /// What the frame shows: `points`, or what `camera` measured.
  [[nodiscard]] Result<Cloud> cloud_of(const DepthImage& image, const Camera& camera,
                                       const Cloud* points) const;
  void judge_imu(StampNs stamp_ns, const Placed& placed);
  void note_motion(StampNs stamp_ns, const Placed& placed);
  void ask_if_due(const DepthImage& image, const Cloud* points, const Placed& placed);

  EngineOptions options;
  int thinning;
  std::optional<ImuTrust> imu;
  std::optional<ExternalOdometry> external;
  Informativeness informativeness;
  Odometry odometry;
  InputHealth inputs;
  RequestSchedule schedule;
  RequestMaker requests;
  PoseDoubt doubt;
  MapLink link;
  StampWatch stamps{{"depth", kClosestFrames, kJudgedFrames}};
  StampNs last_ns = 0;
  StampNs set_back_ns = 0, set_back_by_ns = 0;  ///< where the clock went on, and what it was set back by
  bool started = false;
  std::uint32_t segment = 0;
  std::optional<SpotRequest> request;
  std::vector<std::uint64_t> unanswered;
  LineLimit clock_lines, unanswered_lines, unsent_lines;
};

Result<StampNs> Engine::Impl::check(const DepthImage& image) {
  const Camera& c = options.camera;
  if (image.width != c.width || image.height != c.height)
    return fail("depth image is {}x{}, the camera {}x{}: pass images of the camera's size", image.width,
                image.height, c.width, c.height);
  if (image.units.size() != static_cast<std::size_t>(c.width) * static_cast<std::size_t>(c.height))
    return fail("depth image has {} values, {}x{} needs {}", image.units.size(), c.width, c.height,
                c.width * c.height);
  return stamps.add(image.stamp_ns);
}

/// What was asked and answered counts on by the new clock; the motion in between was seen by nobody.
void Engine::Impl::set_clock_back(StampNs by_ns) {
  log::limited(clock_lines, "{}: the device's clock was set back by {:.1f} s: its odometry begins anew",
               options.client_id, -to_seconds(by_ns));
  schedule.clock_set(by_ns);
  link.clock_set(by_ns);
  doubt.clock_set(by_ns);
  odometry.clock_set();
  if (external) external->frames_clock_set();
  if (imu) imu->frames_clock_set(by_ns);
  set_back_ns = last_ns + by_ns;
  set_back_by_ns = -by_ns;
}

std::string Engine::Impl::clock_problem() const {
  if (set_back_by_ns == 0 || last_ns - set_back_ns > kToldFor) return "";
  return fmt::format("the device's clock was set back by {:.1f} s: the device is located anew",
                     to_seconds(set_back_by_ns));
}

Result<Cloud> Engine::Impl::cloud_of(const DepthImage& image, const Camera& camera, const Cloud* points) const {
  if (points != nullptr) return *points;
  return depth_to_cloud(image, camera,
                        {.min_range_m = options.min_range_m, .max_range_m = options.max_range_m});
}

void Engine::Impl::note_motion(StampNs stamp_ns, const Placed& placed) {
  if (placed.step.segment != segment) schedule.search_begins();
  segment = placed.step.segment;
  if (!external || external->placed()) requests.travelled(stamp_ns, placed.step, placed.informative);
}

Result<Placed> Engine::Impl::place(const DepthImage& image, const Cloud* points, const FrameSpread& spread) {
  Placed placed;
  if (external) {
    placed.step = external->step(image.stamp_ns);
    placed.informative = spread.informative() && external->placed();
    return placed;
  }
  const DepthImage small = thinned(image, thinning);
  const auto cloud = cloud_of(small, thinned(options.camera, thinning), points);
  if (!cloud) return tl::unexpected(cloud.error());
  const std::vector<Surfel> surfels =
      extract_surfels(*cloud, Eigen::Vector3f::Zero(), {.size_m = 2 * options.voxel_size_m});
  const bool enough = surfels.size() >= kFewestSurfels;
  placed.informative = spread.informative() && enough;
  // A spike or drop is a reason not to ask the server; whether the frame fits the map the odometry judges
  // itself.
  const bool matchable =
      enough && spread.fault != FrameFault::covered && spread.fault != FrameFault::too_few_points;
  placed.step = odometry.step(small, surfels, matchable, imu ? imu->believed() : nullptr);
  return placed;
}

/// What registration measured from one frame to the next counts alone: not guesses, nor who may follow
/// somebody.
void Engine::Impl::judge_imu(StampNs stamp_ns, const Placed& placed) {
  const OdometryStep& step = placed.step;
  const bool measured = !external && step.overlap > 0 && step.converged && !step.doubtful &&
                        !step.discontinuous && step.observed.head<3>().minCoeff() > kSeenRotation;
  std::optional<Pose> T_odom_imu;
  if (measured) T_odom_imu = step.T_odom_sensor * options.T_imu_sensor->inverse();
  const bool believed = imu->believed() != nullptr;
  imu->saw(stamp_ns, T_odom_imu, !external && placed.informative && step.source == PoseSource::guess);
  if (inputs.contradicted()) imu->strained();
  if (believed && imu->believed() == nullptr) inputs.forget();
}

void Engine::Impl::ask_if_due(const DepthImage& image, const Cloud* points, const Placed& placed) {
  for (const std::uint64_t seq : schedule.take_unanswered(image.stamp_ns)) {
    unanswered.push_back(seq);
    log::limited(unanswered_lines, "{}: request {} was not answered within {:.1f} s", options.client_id, seq,
                 to_seconds(options.reply_timeout_ns));
  }
  if (!schedule.due(image.stamp_ns, placed.informative, !placed.step.doubtful)) return;
  auto made = cloud_of(image, options.camera, points).and_then([&](const Cloud& cloud_sensor) {
    return requests.make(cloud_sensor, odometry.map(), imu ? imu->believed() : nullptr,
                         link.located(placed.step.segment));
  });
  if (!made) {
    log::limited(unsent_lines, "{}: frame {} is not sent: {}", options.client_id, image.stamp_ns,
                 made.error().message);
    return;
  }
  if (external)
    external->mark();
  else
    odometry.mark();
  doubt.asked(made->stamp_ns);
  schedule.sent(made->seq, made->stamp_ns);
  request = std::move(*made);
}

Result<FrameResult> Engine::Impl::add(const DepthImage& image, const Cloud* points) {
  const auto set_by_ns = check(image);
  if (!set_by_ns) return tl::unexpected(set_by_ns.error());
  if (*set_by_ns < 0) set_clock_back(*set_by_ns);
  const Stopwatch watch;
  const FrameSpread spread =
      informativeness.judge(image, options.camera, options.min_range_m, options.max_range_m);
  log::debug("frame: {} (sd {:.3f} m, {:.2f} valid, {:.2f} near)", name_of(spread.fault), spread.sd_m,
             spread.valid_share, spread.near_share);
  const auto placed = place(image, points, spread);
  if (!placed) return tl::unexpected(placed.error());
  const OdometryStep& step = placed->step;
  note_motion(image.stamp_ns, *placed);
  started = true;
  last_ns = image.stamp_ns;

  FrameResult frame;
  frame.stamp_ns = image.stamp_ns;
  frame.clock_set_back = *set_by_ns < 0;
  frame.informative = placed->informative;
  frame.source = step.source;
  frame.converged = step.converged && !step.discontinuous && !step.doubtful;
  frame.T_odom_sensor = step.T_odom_sensor;
  frame.odom_segment = step.segment;
  frame.residual_m = step.residual_m;
  frame.observed = step.observed;
  inputs.note(spread.fault, step.residual_m, step.strain);
  if (imu) judge_imu(image.stamp_ns, *placed);
  doubt.travelled(
      image.stamp_ns, step, requests.motion_sd(),
      {inputs.contradicted(), !external && placed->informative && step.source == PoseSource::guess});
  if (link.T_map_odom()) frame.T_map_sensor = *link.T_map_odom() * step.T_odom_sensor;
  if (const auto estimate = doubt.estimate(); estimate && frame.T_map_sensor)
    frame.covariance = estimate->covariance;
  frame.latency_ms = watch.elapsed_ms();
  ask_if_due(image, points, *placed);
  return frame;
}

Engine::Engine(EngineOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}
Engine::~Engine() = default;

Status Engine::add_imu(const ImuSample& sample) {
  if (!impl_->imu)
    return fail("{}: IMU sample without T_imu_sensor: set it in the options", impl_->options.client_id);
  return impl_->imu->add(sample);
}

Status Engine::add_odometry(const OdometrySample& sample) {
  if (!impl_->external)
    return fail("{}: odometry from outside, but the local method is another; set it to external",
                impl_->options.client_id);
  return impl_->external->add(sample);
}

Result<FrameResult> Engine::add_depth(const DepthImage& image) {
  return impl_->add(image, nullptr);
}

Result<FrameResult> Engine::add_points(StampNs stamp_ns, const Cloud& cloud_sensor) {
  const EngineOptions& o = impl_->options;
  const Cloud seen = within_view(cloud_sensor, o.camera, o.min_range_m, o.max_range_m);
  return impl_->add(depth_of_points(seen, o.camera, stamp_ns), &seen);
}

void Engine::encode_as(CloudCodec codec) {
  impl_->requests.encode_as(codec);
}

std::optional<SpotRequest> Engine::take_request() {
  return std::exchange(impl_->request, std::nullopt);
}

std::vector<std::uint64_t> Engine::take_unanswered() {
  return std::exchange(impl_->unanswered, {});
}

void Engine::add_reply(const SpotReply& reply) {
  impl_->schedule.answered(reply, impl_->last_ns);
  if (impl_->link.add(reply, impl_->segment)) impl_->doubt.verified(reply);
  if (impl_->link.located(impl_->segment)) impl_->schedule.search_ended();
}

void Engine::server_found() {
  impl_->schedule.server_found();
}

std::string Engine::problem() const {
  if (!impl_->started) return "";
  if (std::string problem = impl_->clock_problem(); !problem.empty()) return problem;
  if (std::string problem = impl_->inputs.problem(); !problem.empty()) return problem;
  if (impl_->external)
    if (std::string problem = impl_->external->problem(); !problem.empty()) return problem;
  if (impl_->external && !impl_->external->placed()) return "no odometry for the newest frame";
  return impl_->imu ? impl_->imu->problem() : "";
}

std::optional<Pose> Engine::T_map_odom() const {
  return impl_->link.T_map_odom();
}

Tracking Engine::tracking() const {
  const auto estimate = impl_->doubt.estimate();
  const EngineOptions& o = impl_->options;
  if (estimate && (estimate->sd_m() > o.lost_sd_m || estimate->sd_rad() > o.lost_sd_rad)) return Tracking::lost;
  return impl_->link.tracking(impl_->last_ns, impl_->segment);
}

}  // namespace liloc
