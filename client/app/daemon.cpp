#include "client/app/daemon.hpp"

#include <cmath>
#include <thread>
#include <utility>

#include "common/wire/sensors.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;

}  // namespace

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
  auto joined = wire::Participant::create(domain);
  if (!joined) return tl::unexpected(joined.error());
  participant_ = std::move(*joined);
  if (!options_.ros.enabled) return {};
  auto ros = RosFace::create(*participant_, options_);
  if (!ros) return tl::unexpected(ros.error());
  ros_ = std::move(*ros);
  return {};
}

Status Daemon::find_camera(const std::function<bool()>& give_up) {
  auto dispatcher = wire::Dispatcher::create(*participant_);
  if (!dispatcher) return tl::unexpected(dispatcher.error());
  std::mutex mutex;
  std::optional<Camera> found;
  const Status ok = wire::subscribe_camera_info_at(
      **dispatcher, options_.topics.camera_info, [&](const Result<Camera>& camera) {
        if (!camera) return log::warning("camera_info: {}", camera.error().message);
        const std::scoped_lock lock(mutex);
        found = *camera;
      });
  if (!ok) return ok;
  log::info("waiting for the intrinsics on {}; --device gives them at once", options_.topics.camera_info);
  (*dispatcher)->start();
  for (bool done = false; !done && !give_up(); std::this_thread::sleep_for(20ms)) {
    const std::scoped_lock lock(mutex);
    done = found.has_value();
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
  auto made = client::Client::create(
      options_.client,
      [this](const client::PoseUpdate& update) {
        if (ros_) ros_->tell(update);
      },
      [this](const client::Reply& reply) {
        log::debug("reply to {}: {} ({}) {}", reply.stamp_ns, reply.status, reply.reason, reply.text);
        if (ros_) ros_->take(reply);
      });
  if (!made) return fail("{}", made.error());
  client_ = std::move(made.value());
  return {};
}

Status Daemon::subscribe_frames() {
  const SensorTopics& topics = options_.topics;
  if (topics.use_points)
    return wire::subscribe_points_at(*sensors_, topics.points,
                                     [this](const Result<wire::StampedCloud>& cloud) { take_points(cloud); });
  if (auto ok = wire::subscribe_depth_at(*sensors_, topics.depth, options_.client.camera.depth_scale_m,
                                         [this](const Result<DepthImage>& image) { take_depth(image); });
      !ok)
    return ok;
  return wire::subscribe_camera_info_at(*sensors_, topics.camera_info, [this](const Result<Camera>& camera) {
    if (camera) check_camera(*camera);
  });
}

Status Daemon::subscribe() {
  auto dispatcher = wire::Dispatcher::create(*participant_);
  if (!dispatcher) return tl::unexpected(dispatcher.error());
  sensors_ = std::move(*dispatcher);
  const SensorTopics& topics = options_.topics;
  if (auto ok = subscribe_frames(); !ok) return ok;
  if (options_.client.T_imu_sensor)
    if (auto ok = wire::subscribe_imu_at(*sensors_, topics.imu,
                                         [this](const Result<ImuSample>& sample) { take_imu(sample); });
        !ok)
      return ok;
  if (!topics.odometry.empty())
    if (auto ok = wire::subscribe_odometry_at(
            *sensors_, topics.odometry,
            [this](const Result<wire::StampedOdometry>& odometry) { take_odometry(odometry); });
        !ok)
      return ok;
  if (ros_) sensors_->every(1000ms, [this] { diagnose(); });
  sensors_->start();
  return {};
}

/// At most one line in five seconds: a misconfigured driver sends a bad sample thirty times a second.
void Daemon::complain(const std::string& what) {
  ++malformed_;
  const auto now = std::chrono::steady_clock::now();
  if (now - complained_ < 5s) return;
  complained_ = now;
  log::warning("{} ({} samples refused so far)", what, malformed_.load());
}

void Daemon::take_depth(const Result<DepthImage>& image) {
  if (!image) return complain(image.error().message);
  const auto taken = client_->push_depth(image->units.data(), image->width, image->height, image->stamp_ns);
  if (!taken) complain(taken.error());
}

void Daemon::take_imu(const Result<ImuSample>& sample) {
  if (!sample) return complain(sample.error().message);
  const Eigen::Vector3d &w = sample->angular_velocity_rad_s, &f = sample->specific_force_m_s2;
  const auto taken = client_->push_imu(sample->stamp_ns, {w.x(), w.y(), w.z()}, {f.x(), f.y(), f.z()});
  if (!taken) complain(taken.error());
}

void Daemon::take_points(const Result<wire::StampedCloud>& cloud) {
  if (!cloud) return complain(cloud.error().message);
  const auto& points = cloud->cloud_sensor.points;
  if (points.empty()) return complain("a cloud without a finite point");
  const auto taken = client_->push_points(points.front().data(), points.size(), cloud->stamp_ns);
  if (!taken) complain(taken.error());
}

void Daemon::take_odometry(const Result<wire::StampedOdometry>& odometry) {
  if (!odometry) return complain(odometry.error().message);
  const std::string& expected = options_.ros.names.odom_frame;
  if (odometry->frame_id != expected && !std::exchange(frame_differs_, true))
    log::warning("odometry is in frame \"{}\", tf is told of \"{}\": set --odom-frame", odometry->frame_id,
                 expected);
  const Eigen::Vector3d t = odometry->T_odom_base.translation();
  const Eigen::Quaterniond q(odometry->T_odom_base.linear());
  std::optional<std::array<double, 36>> covariance;
  if (!odometry->covariance.isZero()) {  // ROS: all zero says unknown
    covariance.emplace();
    Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(covariance->data()) = odometry->covariance;
  }
  const auto taken = client_->push_odometry(odometry->stamp_ns,
                                            {{t.x(), t.y(), t.z()}, {q.x(), q.y(), q.z(), q.w()}}, covariance);
  if (!taken) complain(taken.error());
}

void Daemon::check_camera(const Camera& camera) {
  const client::Camera& c = options_.client.camera;
  const double off = std::max({std::abs(camera.fx - c.fx), std::abs(camera.fy - c.fy),
                               std::abs(camera.cx - c.cx), std::abs(camera.cy - c.cy)});
  const bool differs = camera.width != c.width || camera.height != c.height || off > 1.0;
  if (differs && !camera_differs_)
    log::warning(
        "camera_info ({}x{}, fx {:.1f}) differs from the intrinsics in use ({}x{}, fx {:.1f}): correct {}",
        camera.width, camera.height, camera.fx, c.width, c.height, c.fx,
        options_.device_file.empty() ? "the driver" : options_.device_file);
  camera_differs_ = differs;
}

void Daemon::diagnose() {
  const client::Stats stats = client_->stats();
  const bool silent = std::exchange(frames_diagnosed_, stats.frames) == stats.frames;
  ros_->diagnose(client_->newest(), stats, silent);
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
