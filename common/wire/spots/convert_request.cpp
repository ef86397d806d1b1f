#include "common/base/ids.hpp"
#include "common/wire/spots/convert_fields.hpp"
#include "common/wire/spots/convert_spot.hpp"

namespace liloc::wire {
namespace {

// As idl/liloc.idl has it.
constexpr std::size_t kMaxLocalPoses = 256, kMaxLpcBytes = 262'144, kMaxExtraBytes = 65'536;

Status read_local_poses(const liloc_msg_SpotRequest& message, SpotRequest& request) {
  request.local_poses.reserve(message.local_poses._length);
  StampNs last = 0;
  for (std::uint32_t i = 0; i < message.local_poses._length; ++i) {
    const auto& local = message.local_poses._buffer[i];
    const auto T = pose_of(local.T_odom_sensor, "local_poses.T_odom_sensor");
    if (!T) return tl::unexpected(T.error());
    if (local.stamp_ns < last || local.stamp_ns > message.stamp_ns)
      return fail("local_poses[{}].stamp_ns is {}, must rise up to the request's {}", i, local.stamp_ns,
                  message.stamp_ns);
    last = local.stamp_ns;
    request.local_poses.push_back({local.stamp_ns, *T, local.informative});
  }
  return {};
}

Status read_cloud(const liloc_msg_SpotRequest& message, SpotRequest& request) {
  if (message.codec < 1 || message.codec > 3)
    return fail("codec is {}, must be 1 (Draco), 2 (octree) or 3 (voxel)", message.codec);
  if (message.lpc._length == 0) return fail("lpc is empty; send a frame's cloud");
  request.lpc.codec = static_cast<CloudCodec>(message.codec);
  request.lpc.bytes.assign(message.lpc._buffer, message.lpc._buffer + message.lpc._length);
  request.extra.codec = request.lpc.codec;
  if (message.extra._length > 0)
    request.extra.bytes.assign(message.extra._buffer, message.extra._buffer + message.extra._length);
  return {};
}

Status read_view(const liloc_msg_SpotRequest& message, SpotRequest& request) {
  const auto& c = message.camera;
  const Camera camera{c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.depth_scale_m};
  const auto valid = camera.validated("camera");
  if (!valid) return tl::unexpected(valid.error());
  request.view = {*valid, message.min_range_m, message.max_range_m};
  return all_of(finite(message.min_range_m, "min_range_m", 0, 100),
                finite(message.max_range_m, "max_range_m", message.min_range_m, 1000));
}

Status read_up(const liloc_msg_SpotRequest& message, SpotRequest& request) {
  if (!message.has_up) return {};
  const Eigen::Vector3d up = Eigen::Map<const Eigen::Vector3d>(message.up_sensor);
  if (!up.allFinite() || std::abs(up.norm() - 1) > 1e-2)
    return fail("up_sensor has length {}, must be a unit vector", up.norm());
  request.up_sensor = up.normalized();
  request.up_sd_rad = message.up_sd_rad;
  return finite(message.up_sd_rad, "up_sd_rad", 0, 3.2);
}

}  // namespace

Result<RequestSample> to_wire(const SpotRequest& request, std::uint64_t session) {
  if (request.local_poses.size() > kMaxLocalPoses)
    return fail("request has {} local poses, at most {} travel; thin them", request.local_poses.size(),
                kMaxLocalPoses);
  if (request.lpc.bytes.size() > kMaxLpcBytes)
    return fail("request's LPC has {} bytes, at most {} travel; use a larger voxel", request.lpc.bytes.size(),
                kMaxLpcBytes);
  if (request.extra.bytes.size() > kMaxExtraBytes)
    return fail("request's extra cloud has {} bytes, at most {} travel; thin it", request.extra.bytes.size(),
                kMaxExtraBytes);
  if (!request.extra.bytes.empty() && request.extra.codec != request.lpc.codec)
    return fail("request's extra cloud has another codec than its LPC; encode both alike");
  RequestSample sample;
  auto& m = sample.message;
  m.protocol_version = kProtocolVersion;
  copy_text(m.client_id, request.client_id);
  m.session = session;
  m.seq = request.seq;
  m.stamp_ns = request.stamp_ns;
  m.odom_segment = request.odom_segment;
  m.T_odom_sensor = to_wire(request.T_odom_sensor);
  m.odom_sd_rad = request.odom_sd_rad;
  m.odom_sd_m = request.odom_sd_m;
  for (const auto& local : request.local_poses)
    sample.poses.push_back({local.stamp_ns, to_wire(local.T_odom_sensor), local.informative});
  lend(m.local_poses, sample.poses);
  m.codec = static_cast<std::uint8_t>(request.lpc.codec);
  lend(m.lpc, request.lpc.bytes);
  m.voxel_size_m = request.voxel_size_m;
  const Camera& c = request.view.camera;
  m.camera = {static_cast<std::uint16_t>(c.width),
              static_cast<std::uint16_t>(c.height),
              c.fx,
              c.fy,
              c.cx,
              c.cy,
              c.depth_scale_m};
  m.min_range_m = request.view.min_range_m;
  m.max_range_m = request.view.max_range_m;
  m.has_up = request.up_sensor.has_value();
  if (request.up_sensor) Eigen::Map<Eigen::Vector3d>(m.up_sensor) = *request.up_sensor;
  m.up_sd_rad = request.up_sd_rad;
  m.cold = request.cold;
  m.ceiling_stamp_ns = request.ceiling_stamp_ns;
  m.sent_ns = request.sent_ns;
  lend(m.extra, request.extra.bytes);
  return sample;
}

Result<SpotRequest> from_wire(const liloc_msg_SpotRequest& message) {
  SpotRequest request;
  const auto id = valid_id(text_of(message.client_id), "client_id");
  if (!id) return tl::unexpected(id.error());
  request.client_id = *id;
  request.seq = message.seq;
  request.stamp_ns = message.stamp_ns;
  request.odom_segment = message.odom_segment;
  const auto T = pose_of(message.T_odom_sensor, "T_odom_sensor");
  if (!T) return tl::unexpected(T.error());
  request.T_odom_sensor = *T;
  request.odom_sd_rad = message.odom_sd_rad;
  request.odom_sd_m = message.odom_sd_m;
  request.voxel_size_m = message.voxel_size_m;
  request.cold = message.cold;
  request.ceiling_stamp_ns = message.ceiling_stamp_ns;
  request.sent_ns = message.sent_ns;
  const Status numbers = all_of(
      stamp_of(message.stamp_ns, "stamp_ns"), stamp_of(message.ceiling_stamp_ns, "ceiling_stamp_ns"),
      stamp_of(message.sent_ns, "sent_ns"), finite(message.odom_sd_rad, "odom_sd_rad", 0, 1e3),
      finite(message.odom_sd_m, "odom_sd_m", 0, 1e5), finite(message.voxel_size_m, "voxel_size_m", 0.005, 1.0));
  if (!numbers) return tl::unexpected(numbers.error());
  for (const auto read : {read_local_poses, read_cloud, read_view, read_up})
    if (const Status status = read(message, request); !status) return tl::unexpected(status.error());
  return request;
}

}  // namespace liloc::wire
