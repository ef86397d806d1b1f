#include "client/session/local_registration.hpp"

#include "common/base/limited_log.hpp"

namespace liloc {
namespace {

// Of a frame for the odometry of its stamp; by hand.
constexpr auto kOdometryWait = std::chrono::milliseconds(60);

}  // namespace

LocalRegistration::LocalRegistration(const EngineOptions& options, double cpu_share, SampleInbox& samples,
                                     SessionClock& clock, SessionReport& report)
    : client_id_(options.client_id),
      external_(options.local == LocalMethod::external),
      samples_(samples),
      clock_(clock),
      report_(report),
      engine_(options),
      budget_(cpu_share) {}

Status LocalRegistration::open_trace(const std::filesystem::path& folder) {
  const std::scoped_lock lock(mutex_);
  return trace_.emplace().open(folder);
}

Status LocalRegistration::close_trace() {
  const std::scoped_lock lock(mutex_);
  return trace_ ? trace_->close() : Status{};
}

bool LocalRegistration::skips(StampNs stamp_ns) {
  if (budget_.admit(stamp_ns)) return false;
  if (!std::exchange(skipping_, true))
    log::warning("{}: a frame needs {:.0f} ms of this computer: some frames are left out", client_id_,
                 budget_.interval_ms());
  report_.frame_skipped();
  return true;
}

void LocalRegistration::hand_over_samples() {
  const auto hand_over = [this](const auto& all, auto add_to_engine, SessionReport::Counter refused) {
    std::uint64_t count = 0;
    std::string why;
    for (const auto& sample : all)
      if (const Status ok = (engine_.*add_to_engine)(sample); !ok && ++count == 1) why = ok.error().message;
    if (count > 0) report_.samples_refused(refused, count, why);
  };
  const SampleInbox::Samples taken = samples_.take();
  hand_over(taken.imu, &Engine::add_imu, &SessionStats::imu_refused);
  hand_over(taken.odometry, &Engine::add_odometry, &SessionStats::odometry_refused);
}

/// By the engine, and what it cost.
Result<FrameResult> LocalRegistration::measured(const SensorFrame& input) {
  const Stopwatch watch;
  const double cpu_before_ms = thread_cpu_ms();
  auto frame = input.is_cloud ? engine_.add_points(input.image.stamp_ns, input.points_sensor)
                              : engine_.add_depth(input.image);
  const double cpu_ms = thread_cpu_ms() - cpu_before_ms;
  if (frame) budget_.spent(watch.elapsed_ms(), cpu_ms);
  report_.spent(1e-3 * cpu_ms);
  return frame;
}

/// What the frame that was just added made due.
std::optional<SpotRequest> LocalRegistration::take_request() {
  const auto unanswered = engine_.take_unanswered();
  report_.count(&SessionStats::requests_unanswered, unanswered.size());
  auto request = engine_.take_request();
  if (!trace_) return request;
  for (const std::uint64_t seq : unanswered) trace_->on_timeout(seq);
  if (request) trace_->on_request(*request);
  return request;
}

/// Of the frames that were taken alone: one stray stamp is not to spoil what is known of the clock.
void LocalRegistration::keep_time(const SensorFrame& input, bool set_back) {
  if (set_back) clock_.forget();
  const bool jumped = clock_.frame(input.image.stamp_ns, input.arrived);
  if (!set_back && !jumped) return;
  report_.count(&SessionStats::clock_jumps);
  if (jumped)
    log::limited(clock_lines_, "{}: the device's clock was set to {} ns", client_id_, input.image.stamp_ns);
}

std::optional<LocalRegistration::Registered> LocalRegistration::add(const SensorFrame& input,
                                                                    CloudCodec codec) {
  if (skips(input.image.stamp_ns)) return std::nullopt;
  if (external_) samples_.await_odometry(input.image.stamp_ns, kOdometryWait);
  const std::scoped_lock lock(mutex_);
  return add_locked(input, codec);
}

std::optional<LocalRegistration::Registered> LocalRegistration::add_locked(const SensorFrame& input,
                                                                           CloudCodec codec) {
  hand_over_samples();
  engine_.encode_as(codec);
  const Result<FrameResult> frame = measured(input);
  if (!frame) {
    report_.frame_refused(frame.error().message);
    return std::nullopt;
  }
  keep_time(input, frame->clock_set_back);
  Registered registered{*frame, engine_.tracking(), std::nullopt};
  report_.frame(*frame, registered.tracking, engine_.problem());
  registered.request = take_request();
  if (trace_)
    if (const Status written = trace_->on_frame(*frame); !written)
      report_.trace_failed(written.error().message);
  return registered;
}

void LocalRegistration::add_reply(const SpotReply& reply) {
  const std::scoped_lock lock(mutex_);
  engine_.add_reply(reply);
  if (trace_) trace_->on_reply(reply);
  report_.reply(reply);
}

void LocalRegistration::server_found() {
  const std::scoped_lock lock(mutex_);
  engine_.server_found();
}

}  // namespace liloc
