#include "client/app/daemon.hpp"

#include <mutex>
#include <thread>
#include <utility>

#include "common/wire/sensors/sensors.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;

constexpr auto kFirst = 5s, kAgain = 10s;  // that the intrinsics are missing is told

}  // namespace

Daemon::Daemon(DaemonOptions options)
    : options_(std::move(options)),
      addresses_([interface = options_.client.network_interface] { return wire::addresses_of(interface); }) {}

Result<std::unique_ptr<Daemon>> Daemon::start(DaemonOptions options, const std::function<bool()>& give_up) {
  std::unique_ptr<Daemon> daemon(new Daemon(std::move(options)));
  if (const Status ok = daemon->join(); !ok) return tl::unexpected(ok.error());
  if (daemon->options_.client.camera.width == 0) {
    if (const Status ok = daemon->find_camera(give_up); !ok) return tl::unexpected(ok.error());
    if (daemon->options_.client.camera.width == 0) return std::unique_ptr<Daemon>();
  }
  if (const Status ok = daemon->open_client(); !ok) return tl::unexpected(ok.error());
  if (const Status ok = daemon->subscribe(); !ok) return tl::unexpected(ok.error());
  return daemon;
}

Daemon::~Daemon() {
  if (const Status ok = stop(); !ok) log::error("{}", ok.error().message);
}

Status Daemon::join() {
  wire::DomainOptions domain;
  domain.domain = options_.client.domain;
  domain.role = options_.ros.enabled ? wire::Role::peer : wire::Role::client;
  domain.interface = options_.client.network_interface;
  domain.peers = options_.client.peers;
  domain.credentials = options_.client.credentials;
  auto joined = wire::Participant::create(domain);
  if (!joined) return tl::unexpected(joined.error());
  participant_ = std::move(*joined);
  if (!options_.ros.enabled) return {};
  auto ros = RosBridge::create(*participant_, options_);
  if (!ros) return tl::unexpected(ros.error());
  ros_ = std::move(*ros);
  return {};
}

Status Daemon::find_camera(const std::function<bool()>& give_up) {
  auto dispatcher = wire::Dispatcher::create(*participant_);
  if (!dispatcher) return tl::unexpected(dispatcher.error());
  std::mutex mutex;
  std::optional<Camera> found;
  std::string wrong = fmt::format(
      "nothing arrives on {} (domain {}, interface {}): check the topic's name, and that its driver runs "
      "there; "
      "--device gives the intrinsics",
      options_.topics.camera_info, options_.client.domain, options_.client.network_interface);
  const Status ok = wire::subscribe_camera_info_at(**dispatcher, options_.topics.camera_info,
                                                   [&](const Result<Camera>& camera) {
                                                     const std::scoped_lock lock(mutex);
                                                     if (!camera) {
                                                       wrong = "camera_info: " + camera.error().message;
                                                       return;
                                                     }
                                                     found = *camera;
                                                   });
  if (!ok) return ok;
  log::info("waiting for the intrinsics on {}; --device gives them at once", options_.topics.camera_info);
  (*dispatcher)->start();
  auto told = std::chrono::steady_clock::now() - kAgain + kFirst;
  for (bool done = false; !done && !give_up(); std::this_thread::sleep_for(20ms)) {
    if (const Status same = check_address(); !same) return same;
    const std::scoped_lock lock(mutex);
    done = found.has_value();
    if (done || std::chrono::steady_clock::now() - told < kAgain) continue;
    told = std::chrono::steady_clock::now();
    log::warning("{}", wrong);
  }
  (*dispatcher)->stop();
  if (!found) return {};
  client::Camera& c = options_.client.camera;
  c = {found->width, found->height, found->fx, found->fy, found->cx, found->cy, c.depth_scale_m};
  return {};
}

Status Daemon::open_client() {
  const client::Local local = options_.client.local;
  if ((local == client::Local::inertial || local == client::Local::dead_reckoning) &&
      !options_.client.T_imu_sensor) {
    log::warning("{} has no IMU: --local cloud is used", options_.client.id);
    options_.client.local = client::Local::cloud;
  }
  const SensorTopics& topics = options_.topics;
  options_.client.frames_from = topics.use_points ? topics.points : topics.depth;
  auto made = client::Client::create(
      options_.client,
      [this](const client::PoseUpdate& update) {
        if (ros_) ros_->tell(update);
      },
      [](const client::Reply& reply) {
        log::debug("reply to {}: {} ({}), confidence {:.4f}; {}", reply.stamp_ns, reply.status, reply.reason,
                   reply.confidence, reply.text);
      });
  if (!made) return fail("{}", made.error());
  client_ = std::move(made.value());
  return {};
}

Status Daemon::subscribe() {
  auto dispatcher = wire::Dispatcher::create(*participant_);
  if (!dispatcher) return tl::unexpected(dispatcher.error());
  sensors_ = std::move(*dispatcher);
  feed_ = std::make_unique<SensorFeed>(options_, *client_);
  if (auto ok = feed_->subscribe(*sensors_); !ok) return ok;
  if (ros_) sensors_->every(1000ms, [this] { diagnose(); });
  sensors_->start();
  return {};
}

void Daemon::diagnose() {
  const client::Stats stats = client_->stats();
  const bool silent = std::exchange(frames_diagnosed_, stats.frames) == stats.frames;
  ros_->diagnose(client_->newest(), stats, silent);
}

Status Daemon::check_address() {
  // A start anew costs the pose: where a server was reached at all the addresses were right.
  reached_ = reached_ || (client_ && client_->newest().server_connected);
  if (!addresses_.changed(reached_)) return {};
  return fail(
      "{}: the address on {} has changed, and DDS tells the one before for ever: ending, for systemd to start "
      "this "
      "daemon anew",
      options_.client.id, options_.client.network_interface);
}

std::string Daemon::summary() const {
  const client::Stats s = client_->stats();
  const client::PoseUpdate newest = client_->newest();
  const std::string frames = fmt::format(
      "{} frames ({} dropped, {} left out, {} refused, {} non-informative; {:.1f} ms median, {:.1f} ms p99, "
      "{:.1f} s of CPU{})",
      s.frames, s.frames_dropped, s.frames_skipped, s.frames_refused, s.frames_uninformative, s.frame_ms_median,
      s.frame_ms_p99, s.cpu_s,
      s.localized_s > 0 ? fmt::format(", {:.1f} ms per localized second", 1e3 * s.cpu_s / s.localized_s) : "");
  const std::string answers =
      fmt::format("{} requests ({} unsent, {} unanswered), {} replies ({} verified, {} refused)", s.requests,
                  s.requests_unsent, s.requests_unanswered, s.replies, s.replies_verified, s.replies_refused);
  return fmt::format("{}: {}, server {}; {}, {}; clock {:+.1f} ms (round trip {:.1f} ms{}){}",
                     options_.client.id, name_of(newest.state), newest.server_connected ? "there" : "not there",
                     frames, answers, s.clock_offset_ms, s.clock_round_trip_ms,
                     s.clock_good ? "" : ", not known well", s.problem.empty() ? "" : "; " + s.problem);
}

Status Daemon::stop() {
  if (sensors_) sensors_->stop();
  if (!client_) return {};
  const auto stopped = client_->stop();
  if (!stopped) return fail("{}", stopped.error());
  return {};
}

}  // namespace liloc
