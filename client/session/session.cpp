#include "client/session/session.hpp"

#include <atomic>
#include <mutex>
#include <thread>

#include "client/engine/trace.hpp"
#include "client/session/codec_choice.hpp"
#include "client/session/frame_budget.hpp"
#include "client/session/open_requests.hpp"
#include "client/session/sample_inbox.hpp"
#include "client/session/server_choice.hpp"
#include "client/session/session_clock.hpp"
#include "common/base/bounded_queue.hpp"
#include "common/base/limited_log.hpp"
#include "common/base/stamp_watch.hpp"

namespace liloc {
namespace {

constexpr std::size_t kOutbox = 2;  // an older request is worthless once a newer one waits; by hand
// Above what an answer takes where the ceiling is waited for (100 ms) and a room is searched; by hand.
constexpr auto kUnanswered = std::chrono::milliseconds(250);
constexpr auto kNamesakeTold = std::chrono::seconds(10);  // a few requests of the other device; by hand
// Of a frame for the odometry of its stamp; by hand.
constexpr auto kOdometryWait = std::chrono::milliseconds(60);

/// An image, or a cloud in its place.
struct SensorFrame {
  DepthImage image;  ///< its stamp alone, of a cloud
  bool is_cloud = false;
  Cloud points_sensor;
  SessionClock::Time arrived{};
};

SessionClock::Time now() {
  return std::chrono::steady_clock::now();
}

}  // namespace

struct Session::Impl {
  Impl(SessionOptions o, SessionCallbacks c)
      : options(std::move(o)),
        callbacks(std::move(c)),
        report(options.engine.client_id),
        codecs(options.engine.codec),
        codec(options.engine.codec),
        engine(options.engine),
        budget(options.cpu_share),
        frames(options.queue_frames),
        outbox(kOutbox) {}

  void start();
  [[nodiscard]] Status push(SensorFrame frame);
  template <class Sample>
  [[nodiscard]] Status push(const Sample& sample, const char* what, SessionReport::Counter refused);
  void process(const SensorFrame& input);
  [[nodiscard]] bool skips(StampNs stamp_ns);
  [[nodiscard]] Result<FrameResult> add(const SensorFrame& input);
  void hand_over_samples();
  void keep_time(const SensorFrame& input, bool set_back);
  [[nodiscard]] std::optional<SpotRequest> take_request();
  void send(SpotRequest request);
  [[nodiscard]] CloudCodec choose_codec();
  [[nodiscard]] bool follows(const SpotReply& reply);
  [[nodiscard]] std::optional<SpotReply> take_overdue();
  void tell_change(const std::string& before, const std::string& followed);
  void use(const SpotReply& reply);
  [[nodiscard]] std::string namesake_problem() const {
    return fmt::format("another device asks as {}: give each an id of its own", id());
  }
  [[nodiscard]] const std::string& id() const { return options.engine.client_id; }

  const SessionOptions options;
  const SessionCallbacks callbacks;
  SampleInbox samples;
  SessionClock clock;
  SessionReport report;
  std::atomic<bool> stopped = false;

  std::mutex servers_mutex;  ///< guards what follows, down to namesake_at
  ServerChoice servers;
  CodecChoice codecs;
  CloudCodec codec;  ///< of the newest requests
  OpenRequests open;
  std::optional<SessionClock::Time> unanswered_since;  ///< the first request since the last reply left
  std::optional<SessionClock::Time> namesake_at;

  std::mutex engine_mutex;  ///< held for one frame or one reply
  Engine engine;
  std::optional<TraceWriter> trace;

  FrameBudget budget;                  ///< of the registration thread
  bool skipping = false;               ///< likewise
  LineLimit clock_lines, codec_lines;  ///< likewise
  LineLimit server_lines, jump_lines;  ///< of the network thread

  BoundedQueue<SensorFrame> frames;
  BoundedQueue<SpotRequest> outbox;
  std::jthread registration, sending;  ///< last: they end before what they use
};

void Session::Impl::start() {
  sending = std::jthread([this](const std::stop_token& stop) {
    while (auto request = outbox.pop(stop)) send(std::move(*request));
  });
  registration = std::jthread([this](const std::stop_token& stop) {
    while (auto frame = frames.pop(stop)) process(*frame);
  });
}

bool Session::Impl::skips(StampNs stamp_ns) {
  if (budget.admit(stamp_ns)) return false;
  if (!std::exchange(skipping, true))
    log::warning("{}: a frame needs {:.0f} ms of this computer: some frames are left out", id(),
                 budget.interval_ms());
  report.frame_skipped();
  return true;
}

void Session::Impl::hand_over_samples() {
  const auto hand_over = [this](const auto& all, auto add_to_engine, std::uint64_t SessionStats::*refused) {
    std::uint64_t count = 0;
    std::string why;
    for (const auto& sample : all)
      if (const Status ok = (engine.*add_to_engine)(sample); !ok && ++count == 1) why = ok.error().message;
    if (count > 0) report.samples_refused(refused, count, why);
  };
  const SampleInbox::Samples taken = samples.take();
  hand_over(taken.imu, &Engine::add_imu, &SessionStats::imu_refused);
  hand_over(taken.odometry, &Engine::add_odometry, &SessionStats::odometry_refused);
}

Result<FrameResult> Session::Impl::add(const SensorFrame& input) {
  const Stopwatch watch;
  const double cpu_before_ms = thread_cpu_ms();
  auto frame = input.is_cloud ? engine.add_points(input.image.stamp_ns, input.points_sensor)
                              : engine.add_depth(input.image);
  const double cpu_ms = thread_cpu_ms() - cpu_before_ms;
  if (frame) budget.spent(watch.elapsed_ms(), cpu_ms);
  report.spent(1e-3 * cpu_ms);
  return frame;
}

/// What the frame that was just added made due.
std::optional<SpotRequest> Session::Impl::take_request() {
  const auto unanswered = engine.take_unanswered();
  report.count(&SessionStats::requests_unanswered, unanswered.size());
  auto request = engine.take_request();
  if (!trace) return request;
  for (const std::uint64_t seq : unanswered) trace->on_timeout(seq);
  if (request) trace->on_request(*request);
  return request;
}

/// Of the frames that were taken alone: one stray stamp is not to spoil what is known of the clock.
void Session::Impl::keep_time(const SensorFrame& input, bool set_back) {
  if (set_back) clock.forget();
  const bool jumped = clock.frame(input.image.stamp_ns, input.arrived);
  if (!set_back && !jumped) return;
  report.count(&SessionStats::clock_jumps);
  if (jumped) log::limited(clock_lines, "{}: the device's clock was set to {} ns", id(), input.image.stamp_ns);
}

void Session::Impl::process(const SensorFrame& input) {
  if (skips(input.image.stamp_ns)) return;
  if (options.engine.local == LocalMethod::external)
    samples.await_odometry(input.image.stamp_ns, kOdometryWait);
  std::unique_lock lock(engine_mutex);
  hand_over_samples();
  engine.encode_as(choose_codec());
  const Result<FrameResult> frame = add(input);
  if (!frame) {
    report.frame_refused(frame.error().message);
    return;
  }
  keep_time(input, frame->clock_set_back);
  const Tracking tracking = engine.tracking();
  report.frame(*frame, tracking, engine.problem());
  auto request = take_request();
  if (trace)
    if (const Status written = trace->on_frame(*frame); !written) report.trace_failed(written.error().message);
  lock.unlock();

  if (request) {
    report.count(&SessionStats::requests);
    if (outbox.push(std::move(*request))) report.count(&SessionStats::requests_unsent);
  }
  if (callbacks.on_frame) callbacks.on_frame(*frame, tracking);
}

void Session::Impl::send(SpotRequest request) {
  clock.stamp(request, now());
  {
    const std::scoped_lock lock(servers_mutex);
    open.sent(request);  // before it leaves: an answer may be quicker than the return
    if (!unanswered_since) unanswered_since = now();
  }
  const Status sent = callbacks.send ? callbacks.send(request) : Status(fail("no transport"));
  if (sent) return;
  log::debug("{}: request {} not sent: {}", id(), request.seq, sent.error().message);
  report.count(&SessionStats::requests_unsent);
}

// What is logged is logged without a lock here and below: who hears a line may ask for the stats.

CloudCodec Session::Impl::choose_codec() {
  std::unique_lock lock(servers_mutex);
  const CloudCodec before = std::exchange(codec, codecs.choose(servers.followed(), now()));
  const CloudCodec chosen = codec;
  lock.unlock();
  if (chosen != before)
    log::limited(codec_lines, "{}: clouds travel as {} in place of {}: that is what the servers in sight read",
                 id(), name_of(chosen), name_of(before));
  return chosen;
}

bool Session::Impl::follows(const SpotReply& reply) {
  std::unique_lock lock(servers_mutex);
  if (!open.answered_by(reply)) {
    lock.unlock();
    report.samples_refused(
        &SessionStats::replies_strange, 1,
        fmt::format("a reply of {} to request {}, which was not sent, or too long ago, is dropped",
                    reply.server_id, reply.seq));
    return false;
  }
  unanswered_since.reset();
  const std::string before = servers.followed();
  if (!servers.takes(reply, now())) return false;
  lock.unlock();
  tell_change(before, reply.server_id);
  return true;
}

void Session::Impl::tell_change(const std::string& before, const std::string& followed) {
  if (!before.empty() && followed != before)
    log::limited(server_lines, "{}: {} answers in place of {}", id(), followed, before);
}

std::optional<SpotReply> Session::Impl::take_overdue() {
  std::unique_lock lock(servers_mutex);
  const std::string before = servers.followed();
  auto reply = servers.take_overdue(now());
  lock.unlock();
  if (reply) tell_change(before, reply->server_id);
  return reply;
}

void Session::Impl::use(const SpotReply& reply) {
  if (clock.learn(reply, now())) {
    report.count(&SessionStats::clock_jumps);
    log::limited(jump_lines,
                 "{}: device and ceiling clocks have jumped against each other; the offset is learned anew",
                 id());
  }
  const std::scoped_lock lock(engine_mutex);
  engine.add_reply(reply);
  if (trace) trace->on_reply(reply);
  report.reply(reply);
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
  if (!impl->options.trace_folder.empty()) {
    impl->trace.emplace();
    if (const Status ok = impl->trace->open(impl->options.trace_folder); !ok) return tl::unexpected(ok.error());
  }
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
  const std::scoped_lock lock(impl_->servers_mutex);
  impl_->codecs.heard(server_id, reads, now());
}

bool Session::add_reply(const SpotReply& reply) {
  if (!impl_->follows(reply)) return false;
  impl_->use(reply);
  return true;
}

std::optional<SpotReply> Session::add_overdue_reply() {
  auto reply = impl_->take_overdue();
  if (reply) impl_->use(*reply);
  return reply;
}

bool Session::unanswered() const {
  const std::scoped_lock lock(impl_->servers_mutex);
  return impl_->unanswered_since && now() - *impl_->unanswered_since > kUnanswered;
}

void Session::server_found() {
  const std::scoped_lock lock(impl_->engine_mutex);
  impl_->engine.server_found();
}

void Session::reply_dropped(const std::string& why) {
  impl_->report.reply_dropped(why);
}

void Session::namesake_heard() {
  std::unique_lock lock(impl_->servers_mutex);
  const auto before = std::exchange(impl_->namesake_at, now());
  const bool again = before && *impl_->namesake_at - *before <= kNamesakeTold;
  lock.unlock();
  if (!again) log::warning("{}: {}", impl_->id(), impl_->namesake_problem());
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
  const std::scoped_lock lock(impl_->servers_mutex);
  if (stats.problem.empty() && impl_->namesake_at && now() - *impl_->namesake_at < kNamesakeTold)
    stats.problem = impl_->namesake_problem();
  return stats;
}

Status Session::stop() {
  if (impl_->stopped.exchange(true)) return {};
  impl_->report.ended();
  impl_->samples.close();
  impl_->frames.close();
  if (impl_->registration.joinable()) impl_->registration.join();
  impl_->outbox.close();
  if (impl_->sending.joinable()) impl_->sending.join();
  const std::scoped_lock lock(impl_->engine_mutex);
  return impl_->trace ? impl_->trace->close() : Status{};
}

}  // namespace liloc
