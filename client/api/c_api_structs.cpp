#include "client/api/c_api_structs.hpp"

#include <algorithm>
#include <iterator>

namespace liloc::client::c_api {
namespace {

constexpr int kMaxDomain = 230;  // of DDS: ports of a higher domain exceed 65535

liloc_pose to_c(const Pose& T) {
  liloc_pose pose{};
  std::copy(T.translation_m.begin(), T.translation_m.end(), pose.translation_m);
  std::copy(T.rotation_xyzw.begin(), T.rotation_xyzw.end(), pose.rotation_xyzw);
  return pose;
}

/// The caller's structure as this library knows it.
Result<liloc_client_options> known_part(const liloc_client_options* options, std::size_t size) {
  if (options == nullptr) return fail("options is NULL; pass what liloc_client_options_init filled");
  if (const Status ok = check_size<liloc_client_options>(size, "liloc_client_options"); !ok)
    return tl::unexpected(ok.error());
  const auto* bytes = reinterpret_cast<const unsigned char*>(options);
  const auto set = [](unsigned char byte) { return byte != 0; };
  if (size > sizeof(*options) && std::any_of(bytes + sizeof(*options), bytes + size, set))
    return fail(
        "options has a field that this library ({} bytes of options) does not know; install the library "
        "that the header came with, or leave the field alone",
        sizeof(*options));
  liloc_client_options known{};
  std::memcpy(&known, options, std::min(size, sizeof(known)));
  return known;
}

Status check(const liloc_client_options& o) {
  if (o.id == nullptr) return fail("options.id is NULL; give the device a name, 1..63 of [A-Za-z0-9_-]");
  if (o.network_interface == nullptr)
    return fail("options.network_interface is NULL; a name, an address or \"auto\" (default \"lo\")");
  if (o.domain < 0 || o.domain > kMaxDomain)
    return fail("options.domain is {}; must be 0..{}", o.domain, kMaxDomain);
  if (o.local < LILOC_LOCAL_CLOUD || o.local > LILOC_LOCAL_EXTERNAL)
    return fail("options.local is {}; must be a liloc_local, 0..3", o.local);
  if (o.codec < 0 || o.codec > LILOC_CODEC_VOXEL)
    return fail("options.codec is {}; must be a liloc_codec, 1..3", o.codec);
  if (o.peers == nullptr && o.peer_count > 0)
    return fail("options.peers is NULL, options.peer_count is {}; set both or neither", o.peer_count);
  for (std::size_t i = 0; i < o.peer_count; ++i)
    if (o.peers[i] == nullptr) return fail("options.peers[{}] is NULL; each peer is a host", i);
  return {};
}

}  // namespace

Pose from_c(const liloc_pose& pose) {
  Pose T;
  std::copy(std::begin(pose.translation_m), std::end(pose.translation_m), T.translation_m.begin());
  std::copy(std::begin(pose.rotation_xyzw), std::end(pose.rotation_xyzw), T.rotation_xyzw.begin());
  return T;
}

liloc_client_options default_options() {
  static const Options d;  // its texts outlive every caller
  liloc_client_options o{};
  o.camera.depth_scale_m = d.camera.depth_scale_m;
  o.domain = d.domain;
  o.network_interface = d.network_interface.c_str();
  o.min_range_m = d.min_range_m;
  o.max_range_m = d.max_range_m;
  o.voxel_size_m = d.voxel_size_m;
  o.interval_ms = d.interval_ms;
  o.reply_timeout_ms = d.reply_timeout_ms;
  o.local = static_cast<std::int32_t>(d.local);
  o.T_imu_sensor = to_c(Pose{});
  o.still_seconds = d.still_seconds;
  o.cold = d.cold;
  o.seed = d.seed;
  o.queue_frames = d.queue_frames;
  o.T_base_sensor = to_c(Pose{});
  o.cpu_share = d.cpu_share;
  o.submap = d.submap;
  o.request_bytes = d.request_bytes;
  o.searching_interval_ms = d.searching_interval_ms;
  o.lost_sd_m = d.lost_sd_m;
  o.lost_sd_deg = d.lost_sd_deg;
  o.codec = static_cast<std::int32_t>(d.codec);
  return o;
}

Result<Options> options_from(const liloc_client_options* options, std::size_t size) {
  const auto known = known_part(options, size);
  if (!known) return tl::unexpected(known.error());
  const liloc_client_options& o = *known;
  if (const Status ok = check(o); !ok) return tl::unexpected(ok.error());
  Options out;
  out.id = o.id;
  const liloc_camera& c = o.camera;
  out.camera = {c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.depth_scale_m};
  out.domain = o.domain;
  out.network_interface = o.network_interface;
  out.peers.assign(o.peers, o.peers + o.peer_count);
  out.min_range_m = o.min_range_m;
  out.max_range_m = o.max_range_m;
  out.voxel_size_m = o.voxel_size_m;
  out.interval_ms = o.interval_ms;
  out.reply_timeout_ms = o.reply_timeout_ms;
  out.local = static_cast<Local>(o.local);
  if (o.has_imu) out.T_imu_sensor = from_c(o.T_imu_sensor);
  out.still_seconds = o.still_seconds;
  out.cold = o.cold;
  out.seed = o.seed;
  out.queue_frames = o.queue_frames;
  if (o.trace_folder != nullptr) out.trace_folder = o.trace_folder;
  if (o.has_base) out.T_base_sensor = from_c(o.T_base_sensor);
  out.cpu_share = o.cpu_share;
  out.submap = o.submap;
  if (o.request_bytes != 0) out.request_bytes = o.request_bytes;  // 0 from programs older than the field
  out.searching_interval_ms = o.searching_interval_ms;
  if (o.lost_sd_m != 0) out.lost_sd_m = o.lost_sd_m;  // 0 from programs older than the fields
  if (o.lost_sd_deg != 0) out.lost_sd_deg = o.lost_sd_deg;
  if (o.codec != 0) out.codec = static_cast<Codec>(o.codec);
  if (o.credentials != nullptr) out.credentials = o.credentials;
  return out;
}

liloc_pose_update to_c(const PoseUpdate& update) {
  liloc_pose_update u{};
  u.stamp_ns = update.stamp_ns;
  u.has_map = update.T_map_sensor.has_value();
  u.T_map_sensor = to_c(update.T_map_sensor.value_or(Pose{}));
  u.T_odom_sensor = to_c(update.T_odom_sensor);
  u.odom_segment = update.odom_segment;
  u.informative = update.informative;
  u.converged = update.converged;
  u.state = static_cast<std::int32_t>(update.state);
  u.server_connected = update.server_connected;
  std::copy(update.observed.begin(), update.observed.end(), u.observed);
  std::copy(update.covariance.begin(), update.covariance.end(), u.covariance);
  return u;
}

liloc_reply to_c(const Reply& reply) {
  liloc_reply r{};
  r.stamp_ns = reply.stamp_ns;
  r.verified = reply.verified;
  r.status = reply.status.c_str();
  r.reason = reply.reason.c_str();
  r.text = reply.text.c_str();
  r.has_map = reply.T_map_sensor.has_value();
  r.T_map_sensor = to_c(reply.T_map_sensor.value_or(Pose{}));
  std::copy(reply.covariance.begin(), reply.covariance.end(), r.covariance);
  r.latency_ms = reply.latency_ms;
  r.confidence = reply.confidence;
  r.advice = reply.advice.c_str();
  return r;
}

liloc_stats to_c(const Stats& stats) {
  liloc_stats s{};
  s.frames = stats.frames;
  s.frames_dropped = stats.frames_dropped;
  s.frames_refused = stats.frames_refused;
  s.frames_uninformative = stats.frames_uninformative;
  s.imu_refused = stats.imu_refused;
  s.requests = stats.requests;
  s.requests_unsent = stats.requests_unsent;
  s.requests_unanswered = stats.requests_unanswered;
  s.replies = stats.replies;
  s.replies_verified = stats.replies_verified;
  s.replies_refused = stats.replies_refused;
  s.frame_ms_median = stats.frame_ms_median;
  s.frame_ms_p99 = stats.frame_ms_p99;
  s.frames_skipped = stats.frames_skipped;
  s.odometry_refused = stats.odometry_refused;
  s.cpu_s = stats.cpu_s;
  stats.problem.copy(s.problem, sizeof(s.problem) - 1);  // the rest is 0
  s.clock_offset_ms = stats.clock_offset_ms;
  s.clock_round_trip_ms = stats.clock_round_trip_ms;
  s.clock_good = stats.clock_good;
  s.clock_jumps = stats.clock_jumps;
  s.localized_s = stats.localized_s;
  return s;
}

static_assert(LILOC_LOCAL_EXTERNAL == static_cast<int>(Local::external));
static_assert(LILOC_LOCAL_DEAD_RECKONING == static_cast<int>(Local::dead_reckoning));
static_assert(LILOC_LOCAL_INERTIAL == static_cast<int>(Local::inertial));
static_assert(LILOC_CODEC_DRACO == static_cast<int>(Codec::draco));
static_assert(LILOC_CODEC_OCTREE == static_cast<int>(Codec::octree));
static_assert(LILOC_CODEC_VOXEL == static_cast<int>(Codec::voxel));
static_assert(LILOC_LOST == static_cast<int>(State::lost));
static_assert(LILOC_COASTING == static_cast<int>(State::coasting));
static_assert(LILOC_TRACKING == static_cast<int>(State::tracking));

}  // namespace liloc::client::c_api
