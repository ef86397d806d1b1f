#include "client/engine/engine.hpp"

#include "client/engine/device_motion.hpp"
#include "client/engine/input_health.hpp"
#include "client/engine/map_link.hpp"
#include "client/engine/pose_doubt.hpp"
#include "client/engine/request_maker.hpp"
#include "client/engine/request_schedule.hpp"
#include "client/odometry/informativeness.hpp"
#include "client/odometry/points_view.hpp"
#include "common/base/limited_log.hpp"
#include "common/base/stamp_watch.hpp"

namespace liloc {
namespace {

constexpr int kSilentIntervals = 3;             // without an answer, the server counts as silent; by hand
constexpr StampNs kToldFor = from_ms(3000);     // that the clock was set; by hand
constexpr StampNs kClosestFrames = from_ms(1);  // no depth sensor is as quick as that
constexpr std::size_t kJudgedFrames = 3;        // judge the unit of the stamps, by their mean rise; by hand

RequestScheduleOptions schedule_options(const EngineOptions& o) {
  return {o.interval_ns, o.cold ? o.interval_ns : o.searching_interval_ns, o.reply_timeout_ns};
}

}  // namespace

struct Engine::Impl {
  explicit Impl(EngineOptions o)
      : options(std::move(o)),
        motion(options),
        schedule(schedule_options(options)),
        requests(options),
        link(kSilentIntervals * options.interval_ns) {}

  /// By how much the clock was set (StampWatch).
  [[nodiscard]] Result<StampNs> check(const DepthImage& image);
  void set_clock_back(StampNs by_ns);
  [[nodiscard]] std::string clock_problem() const;
  [[nodiscard]] Result<FrameResult> add(const DepthFrame& frame);
  [[nodiscard]] FrameResult result_of(StampNs stamp_ns, const Placed& placed) const;
  void note_motion(StampNs stamp_ns, const Placed& placed);
  void ask_if_due(const DepthFrame& frame, const Placed& placed);

  EngineOptions options;
  Informativeness informativeness;
  DeviceMotion motion;
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
  motion.clock_set(by_ns);
  set_back_ns = last_ns + by_ns;
  set_back_by_ns = -by_ns;
}

std::string Engine::Impl::clock_problem() const {
  if (set_back_by_ns == 0 || last_ns - set_back_ns > kToldFor) return "";
  return fmt::format("the device's clock was set back by {:.1f} s: the device is located anew",
                     to_seconds(set_back_by_ns));
}

void Engine::Impl::note_motion(StampNs stamp_ns, const Placed& placed) {
  if (placed.step.segment != segment) schedule.search_begins();
  segment = placed.step.segment;
  if (motion.placed()) requests.travelled(stamp_ns, placed.step, placed.informative);
}

void Engine::Impl::ask_if_due(const DepthFrame& frame, const Placed& placed) {
  const StampNs stamp_ns = frame.image.stamp_ns;
  for (const std::uint64_t seq : schedule.take_unanswered(stamp_ns)) {
    unanswered.push_back(seq);
    log::limited(unanswered_lines, "{}: request {} was not answered within {:.1f} s", options.client_id, seq,
                 to_seconds(options.reply_timeout_ns));
  }
  if (!schedule.due(stamp_ns, placed.informative, !placed.step.doubtful)) return;
  auto made = frame.cloud(options.camera, options).and_then([&](const Cloud& cloud_sensor) {
    return requests.make(cloud_sensor, motion.surroundings(), motion.imu(), link.located(placed.step.segment));
  });
  if (!made) {
    log::limited(unsent_lines, "{}: frame {} is not sent: {}", options.client_id, stamp_ns,
                 made.error().message);
    return;
  }
  motion.mark();
  doubt.asked(made->stamp_ns);
  schedule.sent(made->seq, made->stamp_ns);
  request = std::move(*made);
}

FrameResult Engine::Impl::result_of(StampNs stamp_ns, const Placed& placed) const {
  const OdometryStep& step = placed.step;
  FrameResult frame;
  frame.stamp_ns = stamp_ns;
  frame.informative = placed.informative;
  frame.source = step.source;
  frame.converged = step.converged && !step.discontinuous && !step.doubtful;
  frame.T_odom_sensor = step.T_odom_sensor;
  frame.odom_segment = step.segment;
  frame.residual_m = step.residual_m;
  frame.observed = step.observed;
  if (link.T_map_odom()) frame.T_map_sensor = *link.T_map_odom() * step.T_odom_sensor;
  if (const auto estimate = doubt.estimate(); estimate && frame.T_map_sensor)
    frame.covariance = estimate->covariance;
  return frame;
}

Result<FrameResult> Engine::Impl::add(const DepthFrame& frame) {
  const DepthImage& image = frame.image;
  const auto set_by_ns = check(image);
  if (!set_by_ns) return tl::unexpected(set_by_ns.error());
  if (*set_by_ns < 0) set_clock_back(*set_by_ns);
  const Stopwatch watch;
  const FrameSpread spread =
      informativeness.judge(image, options.camera, options.min_range_m, options.max_range_m);
  log::debug("frame: {} (sd {:.3f} m, {:.2f} valid, {:.2f} near)", name_of(spread.fault), spread.sd_m,
             spread.valid_share, spread.near_share);
  const auto placed = motion.place(frame, spread);
  if (!placed) return tl::unexpected(placed.error());
  note_motion(image.stamp_ns, *placed);
  started = true;
  last_ns = image.stamp_ns;
  inputs.note(spread.fault, placed->step.residual_m, placed->step.strain);
  if (motion.judge_imu(image.stamp_ns, *placed, inputs.contradicted())) inputs.forget();
  doubt.travelled(image.stamp_ns, placed->step, requests.motion_sd(), {inputs.contradicted(), placed->misfit});
  FrameResult result = result_of(image.stamp_ns, *placed);
  result.clock_set_back = *set_by_ns < 0;
  result.latency_ms = watch.elapsed_ms();
  ask_if_due(frame, *placed);
  return result;
}

Engine::Engine(EngineOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}
Engine::~Engine() = default;

Status Engine::add_imu(const ImuSample& sample) {
  return impl_->motion.add(sample);
}

Status Engine::add_odometry(const OdometrySample& sample) {
  return impl_->motion.add(sample);
}

Result<FrameResult> Engine::add_depth(const DepthImage& image) {
  return impl_->add({image, nullptr});
}

Result<FrameResult> Engine::add_points(StampNs stamp_ns, const Cloud& cloud_sensor) {
  const EngineOptions& o = impl_->options;
  const Cloud seen = within_view(cloud_sensor, o.camera, o.min_range_m, o.max_range_m);
  const DepthImage image = depth_of_points(seen, o.camera, stamp_ns);
  return impl_->add({image, &seen});
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
  return impl_->motion.problem();
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
