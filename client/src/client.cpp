// The public API on top of a session and a DDS link: converts, checks the options, keeps the order of start and
// stop.
#include "client/include/liloc/client.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "client/src/session.hpp"
#include "common/base/ids.hpp"
#include "common/base/log.hpp"
#include "common/wire/client_link.hpp"

namespace liloc::client {
namespace {

Pose to_public(const liloc::Pose& T) {
  const Eigen::Vector3d t = T.translation();
  const Eigen::Quaterniond q = Eigen::Quaterniond(T.linear()).normalized();
  return {{t.x(), t.y(), t.z()}, {q.x(), q.y(), q.z(), q.w()}};
}

Result<liloc::Pose> to_domain(const Pose& T, std::string_view what) {
  return valid_pose(Eigen::Vector3d(T.translation_m.data()), Eigen::Vector4d(T.rotation_xyzw.data()), what);
}

LocalMethod to_domain(Local local) {
  switch (local) {
    case Local::cloud:
      return LocalMethod::cloud;
    case Local::inertial:
      return LocalMethod::inertial;
    case Local::dead_reckoning:
      return LocalMethod::dead_reckoning;
  }
  return LocalMethod::cloud;
}

State to_public(Tracking tracking) {
  switch (tracking) {
    case Tracking::searching:
      return State::searching;
    case Tracking::tracking:
      return State::tracking;
    case Tracking::coasting:
      return State::coasting;
  }
  return State::searching;
}

Status check_ranges(const Options& o) {
  if (!(o.min_range_m > 0) || !(o.max_range_m > o.min_range_m) || o.max_range_m > 100)
    return fail("options.min_range_m..max_range_m is {}..{}; must rise within 0..100 m", o.min_range_m,
                o.max_range_m);
  if (!(o.voxel_size_m >= 0.01 && o.voxel_size_m <= 0.5))
    return fail("options.voxel_size_m is {}; must be 0.01..0.5", o.voxel_size_m);
  if (o.interval_ms < 50 || o.interval_ms > 60'000)
    return fail("options.interval_ms is {}; must be 50..60000", o.interval_ms);
  if (o.reply_timeout_ms < 100)
    return fail("options.reply_timeout_ms is {}; must be 100 or more", o.reply_timeout_ms);
  if (!(o.still_seconds >= 0 && o.still_seconds <= 600))
    return fail("options.still_seconds is {}; must be 0..600", o.still_seconds);
  if (o.local != Local::cloud && !o.T_imu_sensor)
    return fail("options.local needs an IMU: set options.T_imu_sensor, or choose Local::cloud");
  if (o.queue_frames < 1 || o.queue_frames > 100)
    return fail("options.queue_frames is {}; must be 1..100", o.queue_frames);
  return {};
}

Result<SessionOptions> to_session(const Options& o) {
  SessionOptions s;
  const auto id = valid_id(o.id, "options.id");
  if (!id) return tl::unexpected(id.error());
  if (const Status ok = check_ranges(o); !ok) return tl::unexpected(ok.error());
  const liloc::Camera camera{o.camera.width, o.camera.height, o.camera.fx,           o.camera.fy,
                             o.camera.cx,    o.camera.cy,     o.camera.depth_scale_m};
  const auto valid_camera = camera.validated("options.camera");
  if (!valid_camera) return tl::unexpected(valid_camera.error());
  s.engine.client_id = *id;
  s.engine.camera = *valid_camera;
  s.engine.min_range_m = o.min_range_m;
  s.engine.max_range_m = o.max_range_m;
  s.engine.voxel_size_m = o.voxel_size_m;
  s.engine.interval_ns = from_ms(o.interval_ms);
  s.engine.reply_timeout_ns = from_ms(o.reply_timeout_ms);
  s.engine.local = to_domain(o.local);
  if (o.T_imu_sensor) {
    const auto T = to_domain(*o.T_imu_sensor, "options.T_imu_sensor");
    if (!T) return tl::unexpected(T.error());
    s.engine.T_imu_sensor = *T;
  }
  s.engine.still_seconds = o.still_seconds;
  s.engine.cold = o.cold;
  s.engine.seed = o.seed;
  s.queue_frames = o.queue_frames;
  s.trace_folder = o.trace_folder;
  return s;
}

PoseUpdate to_public(const FrameResult& frame, Tracking tracking, bool connected) {
  PoseUpdate update;
  update.stamp_ns = frame.stamp_ns;
  if (frame.T_map_sensor) update.T_map_sensor = to_public(*frame.T_map_sensor);
  update.T_odom_sensor = to_public(frame.T_odom_sensor);
  update.odom_segment = frame.odom_segment;
  update.informative = frame.informative;
  update.converged = frame.converged;
  update.state = to_public(tracking);
  update.server_connected = connected;
  return update;
}

Reply to_public(const SpotReply& reply) {
  Reply r;
  r.stamp_ns = reply.stamp_ns;
  r.verified = reply.verified();
  r.status = name_of(reply.status);
  r.reason = name_of(reply.reason);
  r.text = reply.text;
  if (reply.T_map_sensor) r.T_map_sensor = to_public(*reply.T_map_sensor);
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(r.covariance.data()) = reply.covariance;
  r.latency_ms = reply.latency_ms;
  return r;
}

Outcome<Taken> to_public(const Status& status) {
  return status ? Outcome<Taken>(Taken{}) : Outcome<Taken>::failed(status.error().message);
}

}  // namespace

void set_log(LogCallback callback) {
  if (!callback) return log::set_sink({});
  log::set_sink([callback = std::move(callback)](log::Level level, std::string_view line) {
    callback(static_cast<int>(level), std::string(line));
  });
}

/// Members go from the last to the first: the link, the dispatcher with its thread, then the session it calls.
struct Client::Impl {
  Status connect(const Options& options);
  void take_server(bool matched);
  Status stop();

  std::string id;
  Camera camera;
  PoseCallback on_pose;
  ReplyCallback on_reply;
  std::atomic<bool> connected = false;
  std::unique_ptr<Session> session;
  std::optional<wire::Participant> participant;
  std::unique_ptr<wire::Dispatcher> dispatcher;
  std::unique_ptr<wire::ClientLink> link;
};

void Client::Impl::take_server(bool matched) {
  connected = matched;
  if (matched)
    log::info("{}: the server is there", id);
  else
    log::warning("{}: the server is gone; the device goes on by itself", id);
}

Status Client::Impl::connect(const Options& options) {
  wire::DomainOptions domain;
  domain.domain = options.domain;
  domain.role = wire::Role::client;
  domain.interface = options.network_interface;
  domain.peers = options.peers;
  auto joined = wire::Participant::create(domain);
  if (!joined) return tl::unexpected(joined.error());
  participant = std::move(*joined);
  auto made = wire::Dispatcher::create(*participant);
  if (!made) return tl::unexpected(made.error());
  dispatcher = std::move(*made);
  wire::ClientCallbacks callbacks;
  callbacks.on_reply = [this](const SpotReply& reply) {
    session->add_reply(reply);
    if (on_reply) on_reply(to_public(reply));
  };
  callbacks.on_server = [this](bool matched) { take_server(matched); };
  callbacks.on_bad_reply = [this](const std::string& why) { log::warning("{}: reply dropped: {}", id, why); };
  auto linked = wire::ClientLink::create(*dispatcher, id, std::move(callbacks));
  if (!linked) return tl::unexpected(linked.error());
  link = std::move(*linked);
  return {};
}

/// Frames first, then requests, then the network: the session's threads still use the link while they end.
Status Client::Impl::stop() {
  const Status stopped = session->stop();
  dispatcher->stop();
  return stopped;
}

Client::Client(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Client::~Client() {
  if (const Status ok = impl_->stop(); !ok) log::error("{}", ok.error().message);
}

Outcome<std::unique_ptr<Client>> Client::create(const Options& options, PoseCallback on_pose,
                                                ReplyCallback on_reply) {
  using Made = Outcome<std::unique_ptr<Client>>;
  auto session_options = to_session(options);
  if (!session_options) return Made::failed(session_options.error().message);
  auto impl = std::make_unique<Impl>();
  Impl& self = *impl;
  self.id = options.id;
  self.camera = options.camera;
  self.on_pose = std::move(on_pose);
  self.on_reply = std::move(on_reply);
  if (const Status ok = self.connect(options); !ok) return Made::failed(ok.error().message);
  SessionCallbacks callbacks;
  callbacks.send = [&self](const SpotRequest& request) { return self.link->send(request); };
  callbacks.on_frame = [&self](const FrameResult& frame, Tracking tracking) {
    if (self.on_pose) self.on_pose(to_public(frame, tracking, self.connected));
  };
  auto session = Session::create(std::move(*session_options), std::move(callbacks));
  if (!session) return Made::failed(session.error().message);
  self.session = std::move(*session);
  self.dispatcher->start();
  return std::unique_ptr<Client>(new Client(std::move(impl)));
}

Outcome<Taken> Client::push_depth(const std::uint16_t* units, int width, int height, std::int64_t stamp_ns) {
  DepthImage image;
  if (units == nullptr || width != impl_->camera.width || height != impl_->camera.height)
    return Outcome<Taken>::failed(fmt::format("{}: depth image is {}x{}, options.camera is {}x{}", impl_->id,
                                              width, height, impl_->camera.width, impl_->camera.height));
  image.stamp_ns = stamp_ns;
  image.width = width;
  image.height = height;
  image.units.assign(units, units + static_cast<std::ptrdiff_t>(width) * height);
  return to_public(impl_->session->push_depth(std::move(image)));
}

Outcome<Taken> Client::push_imu(std::int64_t stamp_ns, const std::array<double, 3>& angular_velocity_rad_s,
                                const std::array<double, 3>& specific_force_m_s2) {
  ImuSample sample;
  sample.stamp_ns = stamp_ns;
  sample.angular_velocity_rad_s = Eigen::Vector3d(angular_velocity_rad_s.data());
  sample.specific_force_m_s2 = Eigen::Vector3d(specific_force_m_s2.data());
  return to_public(impl_->session->push_imu(sample));
}

PoseUpdate Client::newest() const {
  const auto frame = impl_->session->newest_frame();
  if (frame) return to_public(*frame, impl_->session->tracking(), impl_->connected);
  PoseUpdate none;
  none.server_connected = impl_->connected;
  return none;
}

Stats Client::stats() const {
  const SessionStats s = impl_->session->stats();
  return {s.frames,      s.frames_dropped,   s.frames_refused,  s.frames_uninformative,
          s.imu_refused, s.requests,         s.requests_unsent, s.requests_unanswered,
          s.replies,     s.replies_verified, s.replies_refused, s.frame_ms_median,
          s.frame_ms_p99};
}

Outcome<Taken> Client::stop() {
  return to_public(impl_->stop());
}

}  // namespace liloc::client
