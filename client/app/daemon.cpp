#include "client/app/daemon.hpp"

#include <cmath>
#include <thread>

#include "common/wire/sensors.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;

Pose to_domain(const client::Pose& T) {
  Pose pose = Pose::Identity();
  const auto& q = T.rotation_xyzw;
  pose.linear() = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(T.translation_m.data());
  return pose;
}

const char* name_of(client::State state) {
  switch (state) {
    case client::State::searching:
      return "searching";
    case client::State::tracking:
      return "tracking";
    case client::State::coasting:
      return "coasting";
  }
  return "unknown";
}

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
  domain.role = options_.ros ? wire::Role::peer : wire::Role::client;
  domain.interface = options_.client.network_interface;
  domain.peers = options_.client.peers;
  auto joined = wire::Participant::create(domain);
  if (!joined) return tl::unexpected(joined.error());
  participant_ = std::move(*joined);
  if (!options_.ros) return {};
  auto ros = wire::PosePublisher::create(*participant_, options_.client.id);
  if (!ros) return tl::unexpected(ros.error());
  ros_ = std::move(*ros);
  return {};
}

Status Daemon::find_camera(const std::function<bool()>& give_up) {
  auto dispatcher = wire::Dispatcher::create(*participant_);
  if (!dispatcher) return tl::unexpected(dispatcher.error());
  std::mutex mutex;
  std::optional<Camera> found;
  const Status ok =
      wire::subscribe_camera_info(**dispatcher, options_.client.id, [&](const Result<Camera>& camera) {
        if (!camera) return log::warning("camera_info: {}", camera.error().message);
        const std::scoped_lock lock(mutex);
        found = *camera;
      });
  if (!ok) return ok;
  log::info("waiting for the intrinsics on rt/{}/depth/camera_info; --device gives them at once",
            options_.client.id);
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
  if (options_.client.local != client::Local::cloud && !options_.client.T_imu_sensor) {
    log::warning("{} has no IMU: --local cloud is used", options_.client.id);
    options_.client.local = client::Local::cloud;
  }
  auto made = client::Client::create(
      options_.client, [this](const client::PoseUpdate& update) { tell_ros(update); },
      [this](const client::Reply& reply) {
        log::debug("reply to {}: {} ({}) {}", reply.stamp_ns, reply.status, reply.reason, reply.text);
        if (!reply.verified) return;
        const std::scoped_lock lock(covariance_mutex_);
        covariance_ = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(reply.covariance.data());
      });
  if (!made) return fail("{}", made.error());
  client_ = std::move(made.value());
  return {};
}

Status Daemon::subscribe() {
  auto dispatcher = wire::Dispatcher::create(*participant_);
  if (!dispatcher) return tl::unexpected(dispatcher.error());
  sensors_ = std::move(*dispatcher);
  const std::string& id = options_.client.id;
  const double scale = options_.client.camera.depth_scale_m;
  if (auto ok = wire::subscribe_depth(*sensors_, id, scale,
                                      [this](Result<DepthImage> image) { take_depth(std::move(image)); });
      !ok)
    return ok;
  if (auto ok = wire::subscribe_camera_info(*sensors_, id,
                                            [this](const Result<Camera>& camera) {
                                              if (camera) check_camera(*camera);
                                            });
      !ok)
    return ok;
  if (options_.client.T_imu_sensor)
    if (auto ok =
            wire::subscribe_imu(*sensors_, id, [this](const Result<ImuSample>& sample) { take_imu(sample); });
        !ok)
      return ok;
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

void Daemon::take_depth(Result<DepthImage> image) {
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

void Daemon::tell_ros(const client::PoseUpdate& update) {
  if (!ros_) return;
  const Pose T_odom_sensor = to_domain(update.T_odom_sensor);
  std::optional<Pose> T_map_odom;
  Status told = ros_->publish_odometry(update.stamp_ns, T_odom_sensor);
  if (update.T_map_sensor) {
    const Pose T_map_sensor = to_domain(*update.T_map_sensor);
    T_map_odom = T_map_sensor * T_odom_sensor.inverse();
    const std::scoped_lock lock(covariance_mutex_);
    if (told) told = ros_->publish_pose(update.stamp_ns, T_map_sensor, covariance_);
  }
  if (told) told = ros_->publish_tf(update.stamp_ns, T_map_odom, T_odom_sensor);
  if (!told) log::warning("pose not published: {}", told.error().message);
}

std::string Daemon::summary() const {
  const client::Stats s = client_->stats();
  const client::PoseUpdate newest = client_->newest();
  return fmt::format(
      "{}: {}, server {}; {} frames ({} dropped, {} refused, {} non-informative; {:.1f} ms median, {:.1f} ms "
      "p99), {} "
      "requests ({} unsent, {} unanswered), {} replies ({} verified, {} refused)",
      options_.client.id, name_of(newest.state), newest.server_connected ? "there" : "not there", s.frames,
      s.frames_dropped, s.frames_refused, s.frames_uninformative, s.frame_ms_median, s.frame_ms_p99, s.requests,
      s.requests_unsent, s.requests_unanswered, s.replies, s.replies_verified, s.replies_refused);
}

Status Daemon::stop() {
  if (sensors_) sensors_->stop();
  if (!client_) return {};
  const auto stopped = client_->stop();
  if (!stopped) return fail("{}", stopped.error());
  return {};
}

}  // namespace liloc
