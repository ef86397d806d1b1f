#include "client/api/public_types.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/ids.hpp"

namespace liloc::client {
namespace {

Pose to_public(const liloc::Pose& T) {
  const Eigen::Vector3d t = T.translation();
  const Eigen::Quaterniond q = Eigen::Quaterniond(T.linear()).normalized();
  return {{t.x(), t.y(), t.z()}, {q.x(), q.y(), q.z(), q.w()}};
}

LocalMethod to_domain(Local local) {
  switch (local) {
    case Local::cloud:
      return LocalMethod::cloud;
    case Local::inertial:
      return LocalMethod::inertial;
    case Local::dead_reckoning:
      return LocalMethod::dead_reckoning;
    case Local::external:
      return LocalMethod::external;
  }
  return LocalMethod::cloud;
}

CloudCodec to_domain(Codec codec) {
  switch (codec) {
    case Codec::draco:
      return CloudCodec::draco;
    case Codec::octree:
      return CloudCodec::octree;
    case Codec::voxel:
      return CloudCodec::voxel;
  }
  return CloudCodec::draco;
}

State to_public(Tracking tracking) {
  switch (tracking) {
    case Tracking::searching:
      return State::searching;
    case Tracking::tracking:
      return State::tracking;
    case Tracking::coasting:
      return State::coasting;
    case Tracking::lost:
      return State::lost;
  }
  return State::searching;
}

// The public header includes nothing of ours.
static_assert(from_ms(Options{}.interval_ms) == kRequestInterval);

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
  if ((o.local == Local::inertial || o.local == Local::dead_reckoning) && !o.T_imu_sensor)
    return fail("options.local needs an IMU: set options.T_imu_sensor, or choose Local::cloud");
  if (o.queue_frames < 1 || o.queue_frames > 100)
    return fail("options.queue_frames is {}; must be 1..100", o.queue_frames);
  if (!(o.cpu_share >= 0.02 && o.cpu_share <= 1))
    return fail("options.cpu_share is {}; must be 0.02..1", o.cpu_share);
  if (o.request_bytes < 2000 || o.request_bytes > 60'000)
    return fail("options.request_bytes is {}; must be 2000..60000", o.request_bytes);
  if (o.searching_interval_ms < 0 || o.searching_interval_ms > 60'000)
    return fail("options.searching_interval_ms is {}; must be 0..60000", o.searching_interval_ms);
  if (!(o.lost_sd_m >= 0.01 && o.lost_sd_m <= 100))
    return fail("options.lost_sd_m is {}; must be 0.01..100", o.lost_sd_m);
  if (!(o.lost_sd_deg >= 0.1 && o.lost_sd_deg <= 180))
    return fail("options.lost_sd_deg is {}; must be 0.1..180", o.lost_sd_deg);
  if (o.T_base_sensor && o.local != Local::external)
    return fail("options.T_base_sensor is for odometry from outside: set options.local to Local::external");
  return {};
}

}  // namespace

Result<liloc::Pose> to_domain(const Pose& T, std::string_view what) {
  return valid_pose(Eigen::Vector3d(T.translation_m.data()), Eigen::Vector4d(T.rotation_xyzw.data()), what);
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
  if (o.T_base_sensor) {
    const auto T = to_domain(*o.T_base_sensor, "options.T_base_sensor");
    if (!T) return tl::unexpected(T.error());
    s.engine.T_base_sensor = *T;
  }
  s.cpu_share = o.cpu_share;
  s.engine.still_seconds = o.still_seconds;
  s.engine.cold = o.cold;
  s.engine.submap = o.submap;
  s.engine.seed = o.seed;
  s.engine.request_bytes = o.request_bytes;
  s.engine.searching_interval_ns = from_ms(o.searching_interval_ms);
  s.engine.lost_sd_m = o.lost_sd_m;
  s.engine.lost_sd_rad = radians(o.lost_sd_deg);
  s.engine.codec = to_domain(o.codec);
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
  std::copy_n(frame.observed.data(), 6, update.observed.begin());
  if (frame.covariance)
    Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(update.covariance.data()) = *frame.covariance;
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
  r.confidence = reply.confidence;
  r.advice = name_of(reply.advice);
  return r;
}

Stats to_public(const SessionStats& s) {
  Stats stats;
  stats.frames = s.frames;
  stats.frames_dropped = s.frames_dropped;
  stats.frames_refused = s.frames_refused;
  stats.frames_uninformative = s.frames_uninformative;
  stats.imu_refused = s.imu_refused;
  stats.requests = s.requests;
  stats.requests_unsent = s.requests_unsent;
  stats.requests_unanswered = s.requests_unanswered;
  stats.replies = s.replies;
  stats.replies_verified = s.replies_verified;
  stats.replies_refused = s.replies_refused;
  stats.frame_ms_median = s.frame_ms_median;
  stats.frame_ms_p99 = s.frame_ms_p99;
  stats.frames_skipped = s.frames_skipped;
  stats.odometry_refused = s.odometry_refused;
  stats.cpu_s = s.cpu_s;
  stats.problem = s.problem;
  stats.clock_jumps = s.clock_jumps;
  stats.localized_s = s.localized_s;
  if (!s.clock) return stats;
  stats.clock_offset_ms = to_ms(s.clock->offset_ns);
  stats.clock_round_trip_ms = to_ms(s.clock->round_trip_ns);
  stats.clock_good = s.clock->good;
  return stats;
}

}  // namespace liloc::client
