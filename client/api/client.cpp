// The public API on top of a session and a DDS link: converts, checks the options, keeps the order of start and
// stop.
#include "client/include/liloc/client.hpp"

#include <atomic>

#include "client/api/network.hpp"
#include "client/api/public_types.hpp"
#include "client/session/connection_watch.hpp"
#include "common/base/log.hpp"
#include "common/credentials/end_of_credentials.hpp"

namespace liloc::client {
namespace {

// While nobody answers: as long as a server that is back may not know of its clients, at most; by hand.
constexpr auto kAnnounceEvery = std::chrono::milliseconds(250);
constexpr auto kOverdueEvery = std::chrono::milliseconds(20);  // of 100 ms at least that a server may be late
constexpr std::size_t kMostPoints = 4'000'000;                 // as in common/wire/sensors/convert_points.cpp

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

/// Members go from the last to the first: the network with its threads, then the session that it calls.
struct Client::Impl {
  /// A frame that does not even come to the session.
  Outcome<Taken> unusable(const std::string& why) {
    session->refuse_frame(why);
    return Outcome<Taken>::failed(fmt::format("{}: {}", id, why));
  }
  [[nodiscard]] Network::Callbacks network_callbacks();
  Status connect(const Options& options);
  void look();
  Status stop();

  std::string id;
  Camera camera;
  PoseCallback on_pose;
  ReplyCallback on_reply;
  std::atomic<bool> connected = false;
  std::unique_ptr<Session> session;
  std::unique_ptr<ConnectionWatch> watch;
  std::optional<EndOfCredentials> end_of_credentials;
  std::unique_ptr<Network> network;
};

void Client::Impl::look() {
  const auto now = std::chrono::steady_clock::now();
  watch->look(session->stats(), connected, now);
  end_of_credentials->look(now);
}

Network::Callbacks Client::Impl::network_callbacks() {
  Network::Callbacks callbacks;
  callbacks.link.on_reply = [this](const SpotReply& reply) {
    if (session->add_reply(reply) && on_reply) on_reply(to_public(reply));
  };
  callbacks.link.on_server = [this](bool matched) { connected = matched; };
  callbacks.link.on_server_found = [this] { session->server_found(); };
  callbacks.link.on_namesake = [this] { session->namesake_heard(); };
  callbacks.link.on_bad_reply = [this](const std::string& why) { session->reply_dropped(why); };
  callbacks.on_status = [this](const wire::ServerStatus& status) {
    session->add_server(status.server_id, status.codecs);
  };
  callbacks.look = [this] { look(); };
  callbacks.tasks.emplace_back(kOverdueEvery, [this] {
    if (const auto reply = session->add_overdue_reply(); reply && on_reply) on_reply(to_public(*reply));
  });
  callbacks.tasks.emplace_back(kAnnounceEvery, [this] {
    if (session->unanswered()) network->announce();
  });
  return callbacks;
}

Status Client::Impl::connect(const Options& options) {
  wire::DomainOptions seat;
  seat.domain = options.domain;
  seat.role = wire::Role::client;
  seat.interface = options.network_interface;
  seat.peers = options.peers;
  seat.credentials = options.credentials;
  watch = std::make_unique<ConnectionWatch>(
      ConnectionWatch::Names{id, options.frames_from,
                             fmt::format("domain {}, interface {}", options.domain, options.network_interface)},
      std::chrono::steady_clock::now());
  end_of_credentials.emplace(options.credentials, std::chrono::steady_clock::now());
  auto joined = Network::join(std::move(seat), id, network_callbacks());
  if (!joined) return tl::unexpected(joined.error());
  network = std::move(*joined);
  return {};
}

/// Frames first, then requests, then the network: the session's threads still use the link while they end.
Status Client::Impl::stop() {
  const Status stopped = session->stop();
  network->stop();
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
  callbacks.send = [&self](const SpotRequest& request) { return self.network->send(request); };
  callbacks.on_frame = [&self](const FrameResult& frame, Tracking tracking) {
    if (self.on_pose) self.on_pose(to_public(frame, tracking, self.connected));
  };
  auto session = Session::create(std::move(*session_options), std::move(callbacks));
  if (!session) return Made::failed(session.error().message);
  self.session = std::move(*session);
  self.network->start();
  return std::unique_ptr<Client>(new Client(std::move(impl)));
}

Outcome<Taken> Client::push_depth(const std::uint16_t* units, int width, int height, std::int64_t stamp_ns) {
  DepthImage image;
  if (units == nullptr) return impl_->unusable("depth image at NULL");
  if (width != impl_->camera.width || height != impl_->camera.height)
    return impl_->unusable(fmt::format("depth image is {}x{}, options.camera is {}x{}", width, height,
                                       impl_->camera.width, impl_->camera.height));
  image.stamp_ns = stamp_ns;
  image.width = width;
  image.height = height;
  image.units.assign(units, units + static_cast<std::ptrdiff_t>(width) * height);
  return to_public(impl_->session->push_depth(std::move(image)));
}

void Client::push_unusable(const std::string& why) {
  impl_->session->refuse_frame(why);
}

Outcome<Taken> Client::push_points(const float* xyz, std::size_t count, std::int64_t stamp_ns) {
  if (xyz == nullptr || count > kMostPoints)
    return impl_->unusable(
        fmt::format("{} points{}; pass up to {}", count, xyz == nullptr ? " at NULL" : "", kMostPoints));
  Cloud cloud;
  cloud.points.reserve(count);
  for (std::size_t i = 0; i < count; ++i) cloud.points.emplace_back(xyz + 3 * i);
  return to_public(impl_->session->push_points(stamp_ns, std::move(cloud)));
}

Outcome<Taken> Client::push_odometry(std::int64_t stamp_ns, const Pose& T_odom_base,
                                     const std::optional<std::array<double, 36>>& covariance) {
  const auto pose = to_domain(T_odom_base, "T_odom_base");
  if (!pose) return Outcome<Taken>::failed(fmt::format("{}: {}", impl_->id, pose.error().message));
  OdometrySample sample{stamp_ns, *pose, std::nullopt};
  if (covariance)
    sample.covariance = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(covariance->data());
  return to_public(impl_->session->push_odometry(sample));
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

/// That nothing arrives comes first, what the frames show next, who answers last.
Stats Client::stats() const {
  Stats stats = to_public(impl_->session->stats());
  if (std::string silent = impl_->watch->no_frames(); !silent.empty()) stats.problem = std::move(silent);
  if (stats.problem.empty()) stats.problem = impl_->watch->no_answers();
  return stats;
}

Outcome<Taken> Client::stop() {
  return to_public(impl_->stop());
}

}  // namespace liloc::client
