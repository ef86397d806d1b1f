#include "client/src/session.hpp"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <thread>

#include "client/src/frame_budget.hpp"
#include "client/src/trace.hpp"
#include "common/base/bounded_queue.hpp"
#include "common/base/log.hpp"
#include "common/base/stamp_clock.hpp"

namespace liloc {
namespace {

constexpr std::size_t kMostImuSamples = 4000;  // 20 s at 200 Hz, while no frame comes
constexpr std::size_t kLatencies = 512;
constexpr StampNs kLongestStep = from_ms(1000);  // between frames that carry the pose on
constexpr std::size_t kOutbox = 2;               // an older request is worthless once a newer one waits

constexpr auto kOdometryWait = std::chrono::milliseconds(60);  // a frame for the odometry of its stamp

/// An image, or a cloud in its place.
struct SensorFrame {
  DepthImage image;  ///< its stamp alone, of a cloud
  bool is_cloud = false;
  Cloud points_sensor;
};

const char* name_of(Tracking tracking) {
  switch (tracking) {
    case Tracking::searching:
      return "searching";
    case Tracking::tracking:
      return "tracking";
    case Tracking::coasting:
      return "coasting: located by the device alone";
  }
  return "unknown";
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

struct Session::Impl {
  Impl(SessionOptions o, SessionCallbacks c)
      : options(std::move(o)),
        callbacks(std::move(c)),
        engine(options.engine),
        budget(options.cpu_share),
        frames(options.queue_frames),
        outbox(kOutbox) {}

  void start();
  [[nodiscard]] Status push(SensorFrame frame);
  void process(const SensorFrame& input);
  [[nodiscard]] bool skips(StampNs stamp_ns);
  void wait_for_odometry(StampNs stamp_ns);
  [[nodiscard]] Result<FrameResult> add(const SensorFrame& input);
  Tracking note(const FrameResult& frame);
  void hand_over_samples();
  void stamp(SpotRequest& request);
  void learn_clock(const SpotReply& reply);
  void send(SpotRequest request);
  void trace_request(const SpotRequest& request);

  const SessionOptions options;
  const SessionCallbacks callbacks;

  mutable std::mutex engine_mutex;  ///< engine, trace and asked; held for one frame or one reply
  Engine engine;
  std::optional<TraceWriter> trace;
  Status trace_status;
  std::map<std::uint64_t, SpotRequest> asked;  ///< without their clouds

  FrameBudget budget;     ///< of the registration thread
  bool skipping = false;  ///< likewise

  mutable std::mutex state_mutex;  ///< all below; held for moments
  std::condition_variable odometry_came;
  StampClock device_clock;
  ClockEstimator clock;
  std::deque<ImuSample> imu;
  std::deque<OdometrySample> odometry;
  StampNs newest_odometry_ns = 0;
  std::optional<FrameResult> newest;
  Tracking tracking = Tracking::searching;
  SessionStats stats;
  std::deque<double> latencies_ms;
  bool stopped = false;

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

void Session::Impl::hand_over_samples() {
  std::deque<ImuSample> inertial;
  std::deque<OdometrySample> poses;
  {
    const std::scoped_lock lock(state_mutex);
    inertial.swap(imu);
    poses.swap(odometry);
  }
  std::uint64_t imu_refused = 0, odometry_refused = 0;
  for (const ImuSample& sample : inertial)
    if (const Status ok = engine.add_imu(sample); !ok && ++imu_refused == 1)
      log::warning("{}", ok.error().message);
  for (const OdometrySample& sample : poses)
    if (const Status ok = engine.add_odometry(sample); !ok && ++odometry_refused == 1)
      log::warning("{}", ok.error().message);
  const std::scoped_lock lock(state_mutex);
  stats.imu_refused += imu_refused;
  stats.odometry_refused += odometry_refused;
}

/// A pose between two samples is better than one guessed beyond the newest.
void Session::Impl::wait_for_odometry(StampNs stamp_ns) {
  std::unique_lock lock(state_mutex);
  if (newest_odometry_ns == 0) return;
  odometry_came.wait_for(lock, kOdometryWait, [&] { return stopped || newest_odometry_ns >= stamp_ns; });
}

bool Session::Impl::skips(StampNs stamp_ns) {
  const bool skip = !budget.admit(stamp_ns);
  if (skip && !skipping)
    log::warning("{}: a frame needs {:.0f} ms of this computer: some frames are left out",
                 options.engine.client_id, budget.interval_ms());
  skipping = skipping || skip;
  if (!skip) return false;
  const std::scoped_lock lock(state_mutex);
  ++stats.frames_skipped;
  return true;
}

Result<FrameResult> Session::Impl::add(const SensorFrame& input) {
  const Stopwatch watch;
  const double cpu_before_ms = thread_cpu_ms();
  auto frame = input.is_cloud ? engine.add_points(input.image.stamp_ns, input.points_sensor)
                              : engine.add_depth(input.image);
  const double cpu_ms = thread_cpu_ms() - cpu_before_ms;
  if (frame) budget.spent(watch.elapsed_ms(), cpu_ms);
  const std::scoped_lock lock(state_mutex);
  stats.cpu_s += 1e-3 * cpu_ms;
  return frame;
}

void Session::Impl::trace_request(const SpotRequest& request) {
  if (trace) trace->on_request(request);
  SpotRequest light = request;
  light.lpc.bytes.clear();
  light.extra.bytes.clear();
  light.local_poses.clear();
  asked[request.seq] = std::move(light);
}

Tracking Session::Impl::note(const FrameResult& frame) {
  const Tracking now = engine.tracking();
  std::string problem = engine.problem();
  const std::scoped_lock lock(state_mutex);
  if (!problem.empty() && problem.substr(0, 12) != stats.problem.substr(0, 12))  // figures in it change
    log::warning("{}: {}", options.engine.client_id, problem);
  stats.problem = std::move(problem);
  ++stats.frames;
  stats.frames_uninformative += frame.informative ? 0 : 1;
  latencies_ms.push_back(frame.latency_ms);
  if (latencies_ms.size() > kLatencies) latencies_ms.pop_front();
  if (newest && frame.T_map_sensor)  // a pause is not counted in full
    stats.localized_s += to_seconds(std::min(frame.stamp_ns - newest->stamp_ns, kLongestStep));
  newest = frame;
  if (now == tracking) return now;
  log::write(now == Tracking::coasting ? log::Level::warning : log::Level::info,
             fmt::format("{}: {}", options.engine.client_id, name_of(now)));
  tracking = now;
  return now;
}

void Session::Impl::process(const SensorFrame& input) {
  if (skips(input.image.stamp_ns)) return;
  if (options.engine.local == LocalMethod::external) wait_for_odometry(input.image.stamp_ns);
  std::optional<SpotRequest> request;
  Result<FrameResult> frame = fail("not processed");
  Tracking now = Tracking::searching;
  {
    const std::scoped_lock lock(engine_mutex);
    hand_over_samples();
    frame = add(input);
    if (frame) {
      now = note(*frame);
      request = engine.take_request();
      if (request) trace_request(*request);
      const auto unanswered = engine.take_unanswered();
      for (const std::uint64_t seq : unanswered) {
        asked.erase(seq);
        if (trace) trace->on_timeout(seq);
      }
      if (trace && trace_status) trace_status = trace->on_frame(*frame);
      const std::scoped_lock state(state_mutex);
      stats.requests_unanswered += unanswered.size();
    }
  }
  if (!frame) {
    log::warning("{}: {}", options.engine.client_id, frame.error().message);
    const std::scoped_lock lock(state_mutex);
    ++stats.frames_refused;
    return;
  }
  if (request) {
    const bool displaced = outbox.push(std::move(*request)).has_value();
    const std::scoped_lock lock(state_mutex);
    ++stats.requests;
    stats.requests_unsent += displaced ? 1 : 0;
  }
  if (callbacks.on_frame) callbacks.on_frame(*frame, now);
}

/// The time of sending, and the frame's time by the ceiling's clock where that is known well.
void Session::Impl::stamp(SpotRequest& request) {
  const std::scoped_lock lock(state_mutex);
  request.sent_ns = device_clock.now(std::chrono::steady_clock::now()).value_or(0);
  request.ceiling_stamp_ns = clock.ceiling_stamp(request.stamp_ns).value_or(0);
}

void Session::Impl::learn_clock(const SpotReply& reply) {
  const std::scoped_lock lock(state_mutex);
  const auto now = device_clock.now(std::chrono::steady_clock::now());
  if (!now) return;
  if (clock.add({reply.request_sent_ns, reply.server_received_ns, reply.server_sent_ns, *now})) {
    ++stats.clock_jumps;
    log::warning("{}: device and ceiling clocks have jumped against each other; the offset is learned anew",
                 options.engine.client_id);
  }
}

void Session::Impl::send(SpotRequest request) {
  stamp(request);
  const Status sent = callbacks.send ? callbacks.send(request) : Status(fail("no transport"));
  if (sent) return;
  log::debug("{}: request {} not sent: {}", options.engine.client_id, request.seq, sent.error().message);
  const std::scoped_lock lock(state_mutex);
  ++stats.requests_unsent;
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

Status Session::Impl::push(SensorFrame frame) {
  {
    const std::scoped_lock lock(state_mutex);
    if (stopped) return fail("{}: stopped: no more frames are taken", options.engine.client_id);
    if (device_clock.add(frame.image.stamp_ns, std::chrono::steady_clock::now())) {
      clock.reset();
      ++stats.clock_jumps;
      log::warning("{}: the device's clock was set to {} ns", options.engine.client_id, frame.image.stamp_ns);
    }
  }
  if (!frames.push(std::move(frame))) return {};
  const std::scoped_lock lock(state_mutex);
  ++stats.frames_dropped;
  return {};
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

Status Session::push_odometry(const OdometrySample& sample) {
  {
    const std::scoped_lock lock(impl_->state_mutex);
    if (impl_->options.engine.local != LocalMethod::external)
      return fail("{}: odometry from outside, but options.local is another; set it to external",
                  impl_->options.engine.client_id);
    if (impl_->stopped) return fail("{}: stopped: no more samples are taken", impl_->options.engine.client_id);
    if (impl_->odometry.size() >= kMostImuSamples) impl_->odometry.pop_front();
    impl_->odometry.push_back(sample);
    impl_->newest_odometry_ns = std::max(impl_->newest_odometry_ns, sample.stamp_ns);
  }
  impl_->odometry_came.notify_all();
  return {};
}

Status Session::push_imu(const ImuSample& sample) {
  const std::scoped_lock lock(impl_->state_mutex);
  if (!impl_->options.engine.T_imu_sensor)
    return fail("{}: IMU sample without T_imu_sensor: set it in the options", impl_->options.engine.client_id);
  if (impl_->stopped) return fail("{}: stopped: no more samples are taken", impl_->options.engine.client_id);
  if (impl_->imu.size() >= kMostImuSamples) impl_->imu.pop_front();
  impl_->imu.push_back(sample);
  return {};
}

void Session::add_reply(const SpotReply& reply) {
  impl_->learn_clock(reply);
  const std::scoped_lock lock(impl_->engine_mutex);
  impl_->engine.add_reply(reply);
  const auto asked = impl_->asked.find(reply.seq);
  if (impl_->trace && asked != impl_->asked.end()) impl_->trace->on_reply(reply, asked->second);
  if (asked != impl_->asked.end()) impl_->asked.erase(asked);
  const std::scoped_lock state(impl_->state_mutex);
  ++impl_->stats.replies;
  impl_->stats.replies_verified += reply.verified() ? 1 : 0;
  impl_->stats.replies_refused += reply.status == SpotStatus::refused ? 1 : 0;
}

std::optional<FrameResult> Session::newest_frame() const {
  const std::scoped_lock lock(impl_->state_mutex);
  return impl_->newest;
}

Tracking Session::tracking() const {
  const std::scoped_lock lock(impl_->state_mutex);
  return impl_->tracking;
}

SessionStats Session::stats() const {
  const std::scoped_lock lock(impl_->state_mutex);
  SessionStats stats = impl_->stats;
  stats.clock = impl_->clock.offset();
  const std::vector<double> latencies(impl_->latencies_ms.begin(), impl_->latencies_ms.end());
  stats.frame_ms_median = quantile(latencies, 0.5);
  stats.frame_ms_p99 = quantile(latencies, 0.99);
  return stats;
}

Status Session::stop() {
  {
    const std::scoped_lock lock(impl_->state_mutex);
    if (std::exchange(impl_->stopped, true)) return {};
  }
  impl_->odometry_came.notify_all();
  impl_->frames.close();
  if (impl_->registration.joinable()) impl_->registration.join();
  impl_->outbox.close();
  if (impl_->sending.joinable()) impl_->sending.join();
  const std::scoped_lock lock(impl_->engine_mutex);
  if (!impl_->trace) return {};
  const Status closed = impl_->trace->close();
  return impl_->trace_status ? closed : impl_->trace_status;
}

}  // namespace liloc
