#include "client/session/session.hpp"

#include <atomic>
#include <thread>

#include "client/session/local_registration.hpp"
#include "client/session/server_talk.hpp"
#include "common/base/bounded_queue.hpp"
#include "common/base/limited_log.hpp"
#include "common/base/stamp_watch.hpp"

namespace liloc {
namespace {

SessionClock::Time now() {
  return std::chrono::steady_clock::now();
}

}  // namespace

struct Session::Impl {
  Impl(SessionOptions o, SessionCallbacks c)
      : options(std::move(o)),
        callbacks(std::move(c)),
        report(options.engine.client_id),
        talk(id(), options.engine.codec, callbacks.send, clock, report),
        local(options.engine, options.cpu_share, samples, clock, report),
        frames(options.queue_frames) {}

  void start();
  [[nodiscard]] Status push(SensorFrame frame);
  template <class Sample>
  [[nodiscard]] Status push(const Sample& sample, const char* what, SessionReport::Counter refused);
  void register_frame(const SensorFrame& input);
  void use(const SpotReply& reply);
  [[nodiscard]] const std::string& id() const { return options.engine.client_id; }

  const SessionOptions options;
  const SessionCallbacks callbacks;
  SampleInbox samples;
  SessionClock clock;
  SessionReport report;
  std::atomic<bool> stopped = false;
  ServerTalk talk;
  LocalRegistration local;
  LineLimit jump_lines;  ///< of the network thread

  BoundedQueue<SensorFrame> frames;
  std::jthread registration;  ///< last: it ends before what it uses
};

void Session::Impl::start() {
  registration = std::jthread([this](const std::stop_token& stop) {
    while (auto frame = frames.pop(stop)) register_frame(*frame);
  });
}

void Session::Impl::register_frame(const SensorFrame& input) {
  auto registered = local.add(input, talk.choose_codec());
  if (!registered) return;
  if (registered->request) talk.ask(std::move(*registered->request));
  if (callbacks.on_frame) callbacks.on_frame(registered->frame, registered->tracking);
}

void Session::Impl::use(const SpotReply& reply) {
  if (clock.learn(reply, now())) {
    report.count(&SessionStats::clock_jumps);
    log::limited(jump_lines,
                 "{}: device and ceiling clocks have jumped against each other; the offset is learned anew",
                 id());
  }
  local.add_reply(reply);
}

Status Session::Impl::push(SensorFrame frame) {
  if (stopped) return fail("{}: stopped: no more frames are taken", id());
  if (const Status ok = check_unit_by(wall_clock_ns(), frame.image.stamp_ns, "depth"); !ok) {
    report.frame_refused(ok.error().message);
    return fail("{}: {}", id(), ok.error().message);
  }
  frame.arrived = now();
  if (frames.push(std::move(frame))) report.count(&SessionStats::frames_dropped);
  return {};
}

template <class Sample>
Status Session::Impl::push(const Sample& sample, const char* what, SessionReport::Counter refused) {
  if (stopped) return fail("{}: stopped: no more samples are taken", id());
  if (const Status ok = check_unit_by(wall_clock_ns(), sample.stamp_ns, what); !ok) {
    report.samples_refused(refused, 1, ok.error().message);
    return fail("{}: {}", id(), ok.error().message);
  }
  samples.add(sample);
  return {};
}

Session::Session(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Session::~Session() {
  if (const Status ok = stop(); !ok) log::error("{}", ok.error().message);
}

Result<std::unique_ptr<Session>> Session::create(SessionOptions options, SessionCallbacks callbacks) {
  auto impl = std::make_unique<Impl>(std::move(options), std::move(callbacks));
  if (const auto& folder = impl->options.trace_folder; !folder.empty())
    if (const Status ok = impl->local.open_trace(folder); !ok) return tl::unexpected(ok.error());
  impl->start();
  return std::unique_ptr<Session>(new Session(std::move(impl)));
}

Status Session::push_depth(DepthImage image) {
  return impl_->push({std::move(image), false, {}});
}

Status Session::push_points(StampNs stamp_ns, Cloud cloud_sensor) {
  SensorFrame frame;
  frame.image.stamp_ns = stamp_ns;
  frame.is_cloud = true;
  frame.points_sensor = std::move(cloud_sensor);
  return impl_->push(std::move(frame));
}

void Session::refuse_frame(const std::string& why) {
  if (!impl_->stopped) impl_->report.frame_refused(why);
}

Status Session::push_odometry(const OdometrySample& sample) {
  if (impl_->options.engine.local != LocalMethod::external)
    return fail("{}: odometry from outside, but options.local is another; set it to external", impl_->id());
  return impl_->push(sample, "odometry", &SessionStats::odometry_refused);
}

Status Session::push_imu(const ImuSample& sample) {
  if (!impl_->options.engine.T_imu_sensor)
    return fail("{}: IMU sample without T_imu_sensor: set it in the options", impl_->id());
  if (!sample.angular_velocity_rad_s.allFinite() || !sample.specific_force_m_s2.allFinite()) {
    impl_->report.count(&SessionStats::imu_refused);
    return fail("{}: IMU sample at {} ns is not finite", impl_->id(), sample.stamp_ns);
  }
  return impl_->push(sample, "IMU", &SessionStats::imu_refused);
}

void Session::add_server(const std::string& server_id, const std::vector<CloudCodec>& reads) {
  impl_->talk.heard_server(server_id, reads);
}

bool Session::add_reply(const SpotReply& reply) {
  if (!impl_->talk.takes(reply)) return false;
  impl_->use(reply);
  return true;
}

std::optional<SpotReply> Session::add_overdue_reply() {
  auto reply = impl_->talk.take_overdue();
  if (reply) impl_->use(*reply);
  return reply;
}

bool Session::unanswered() const {
  return impl_->talk.unanswered();
}

void Session::server_found() {
  impl_->local.server_found();
}

void Session::reply_dropped(const std::string& why) {
  impl_->report.reply_dropped(why);
}

void Session::namesake_heard() {
  impl_->talk.namesake_heard();
}

std::optional<FrameResult> Session::newest_frame() const {
  return impl_->report.newest();
}

Tracking Session::tracking() const {
  return impl_->report.tracking();
}

SessionStats Session::stats() const {
  SessionStats stats = impl_->report.stats();
  stats.clock = impl_->clock.offset();
  if (stats.problem.empty()) stats.problem = impl_->talk.problem();
  return stats;
}

Status Session::stop() {
  if (impl_->stopped.exchange(true)) return {};
  impl_->report.ended();
  impl_->samples.close();
  impl_->frames.close();
  if (impl_->registration.joinable()) impl_->registration.join();
  impl_->talk.close();
  return impl_->local.close_trace();
}

}  // namespace liloc
