#include "client/app/ros_bridge.hpp"

#include <chrono>

#include "common/base/limited_log.hpp"

namespace liloc {
namespace {

Pose to_domain(const client::Pose& T) {
  Pose pose = Pose::Identity();
  const auto& q = T.rotation_xyzw;
  pose.linear() = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
  pose.translation() = Eigen::Vector3d(T.translation_m.data());
  return pose;
}

}  // namespace

const char* name_of(client::State state) {
  switch (state) {
    case client::State::searching:
      return "searching";
    case client::State::tracking:
      return "tracking";
    case client::State::coasting:
      return "coasting";
    case client::State::lost:
      return "lost";
  }
  return "unknown";
}

RosBridge::RosBridge(wire::RosPublisher publisher, const DaemonOptions& options)
    : id_(options.client.id),
      odometry_is_ours_(options.client.local != client::Local::external),
      ahead_ns_(from_ms(options.ros.tf_ahead_ms)),
      publisher_(std::move(publisher)),
      slew_(options.ros.tf_max_speed_m_s, radians(options.ros.tf_max_turn_deg_s)) {}

Result<std::unique_ptr<RosBridge>> RosBridge::create(const wire::Participant& participant,
                                                     const DaemonOptions& options) {
  auto publisher = wire::RosPublisher::create(participant, options.client.id, options.ros.names);
  if (!publisher) return tl::unexpected(publisher.error());
  return std::unique_ptr<RosBridge>(new RosBridge(std::move(*publisher), options));
}

void RosBridge::tell(const client::PoseUpdate& update) {
  const std::scoped_lock lock(mutex_);
  const Pose T_odom_sensor = to_domain(update.T_odom_sensor);
  Status told;
  if (odometry_is_ours_) {
    told = publisher_.publish_odometry(update.stamp_ns, T_odom_sensor);
    if (told) told = publisher_.publish_odom_sensor(update.stamp_ns, T_odom_sensor);
  }
  if (told && update.T_map_sensor) {
    const Pose T_map_sensor = to_domain(*update.T_map_sensor);
    told = publisher_.publish_pose(
        update.stamp_ns, T_map_sensor,
        Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(update.covariance.data()));
    const Pose T_map_odom = slew_.follow(update.stamp_ns, T_map_sensor * T_odom_sensor.inverse(), T_odom_sensor,
                                         update.odom_segment);
    if (told) told = publisher_.publish_map_odom(update.stamp_ns + ahead_ns_, T_map_odom);
  }
  if (!told) log::limited(lines_, "{}: not published: {}", id_, told.error().message);
}

wire::Diagnosis diagnosis_of(const std::string& id, const client::PoseUpdate& newest, const client::Stats& s,
                             bool silent) {
  using Level = wire::Diagnosis::Level;
  wire::Diagnosis d;
  d.name = "liloc-client: " + id;
  d.level = newest.state == client::State::tracking ? Level::ok : Level::warn;
  d.message = name_of(newest.state);
  if (newest.state == client::State::lost) d.level = Level::error;
  if (!newest.server_connected) d.message += ", no server";
  if (!s.problem.empty()) {
    if (d.level == Level::ok) d.level = Level::warn;
    d.message += ", " + s.problem;
  }
  if (silent) {
    d.level = Level::stale;
    d.message = "no frames come";
  }
  const auto add = [&d](const char* key, auto value) { d.values.emplace_back(key, fmt::format("{}", value)); };
  add("state", name_of(newest.state));
  add("server", newest.server_connected ? "connected" : "not there");
  add("odometry segment", newest.odom_segment);
  add("frames", s.frames);
  add("frames dropped", s.frames_dropped);
  add("frames refused", s.frames_refused);
  add("frames left out", s.frames_skipped);
  add("frames non-informative", s.frames_uninformative);
  add("frame ms (median)", s.frame_ms_median);
  add("frame ms (p99)", s.frame_ms_p99);
  add("cpu s", s.cpu_s);
  add("requests", s.requests);
  add("requests unsent", s.requests_unsent);
  add("requests unanswered", s.requests_unanswered);
  add("clock offset ms", s.clock_offset_ms);
  add("clock round trip ms", s.clock_round_trip_ms);
  add("clock known", s.clock_good);
  add("clock jumps", s.clock_jumps);
  add("replies verified", s.replies_verified);
  add("replies refused", s.replies_refused);
  return d;
}

void RosBridge::diagnose(const client::PoseUpdate& newest, const client::Stats& stats, bool silent) {
  const Status told = publisher_.publish_diagnosis(wall_clock_ns(), diagnosis_of(id_, newest, stats, silent));
  if (told) return;
  const std::scoped_lock lock(mutex_);
  log::limited(lines_, "{}: not published: {}", id_, told.error().message);
}

}  // namespace liloc
