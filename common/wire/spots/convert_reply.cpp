#include "common/wire/spots/convert_fields.hpp"
#include "common/wire/spots/convert_spot.hpp"

namespace liloc::wire {
namespace {

Status read_pose(bool set, const liloc_msg_Transform& T, std::string_view what, std::optional<Pose>& to) {
  if (!set) return {};
  const auto pose = pose_of(T, what);
  if (!pose) return tl::unexpected(pose.error());
  to = *pose;
  return {};
}

}  // namespace

liloc_msg_SpotReply to_wire(const SpotReply& reply, std::uint64_t session) {
  liloc_msg_SpotReply m{};
  m.protocol_version = kProtocolVersion;
  copy_text(m.server_id, reply.server_id);
  copy_text(m.client_id, reply.client_id);
  m.session = session;
  m.seq = reply.seq;
  m.stamp_ns = reply.stamp_ns;
  m.gpc_stamp_ns = reply.gpc_stamp_ns;
  m.status = static_cast<std::uint8_t>(reply.status);
  m.reason = static_cast<std::uint8_t>(reply.reason);
  copy_text(m.text, reply.text);
  m.has_T_map_sensor = reply.T_map_sensor.has_value();
  m.T_map_sensor = to_wire(reply.T_map_sensor.value_or(Pose::Identity()));
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(m.covariance) = reply.covariance;
  m.fitness = reply.fitness;
  m.inlier_rmse_m = reply.inlier_rmse_m;
  m.overlap = reply.overlap;
  m.margin = reply.margin;
  m.has_T_map_odom = reply.T_map_odom.has_value();
  m.T_map_odom = to_wire(reply.T_map_odom.value_or(Pose::Identity()));
  m.odom_segment = reply.odom_segment;
  m.latency_ms = reply.latency_ms;
  m.request_sent_ns = reply.request_sent_ns;
  m.server_received_ns = reply.server_received_ns;
  m.server_sent_ns = reply.server_sent_ns;
  m.confidence = reply.confidence;
  m.advice = static_cast<std::uint8_t>(reply.advice);
  return m;
}

Result<SpotReply> from_wire(const liloc_msg_SpotReply& message) {
  SpotReply reply;
  reply.client_id = text_of(message.client_id);
  reply.server_id = text_of(message.server_id);
  reply.seq = message.seq;
  reply.stamp_ns = message.stamp_ns;
  reply.gpc_stamp_ns = message.gpc_stamp_ns;
  if (message.status < 1 || message.status > 3) return fail("status is {}, must be 1..3", message.status);
  reply.status = static_cast<SpotStatus>(message.status);
  reply.reason = static_cast<Reason>(message.reason);  // a newer server may know more reasons than name_of does
  reply.text = text_of(message.text);
  reply.covariance = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(message.covariance);
  if (!reply.covariance.allFinite() || reply.covariance.diagonal().minCoeff() < 0)
    return fail("covariance is not finite or has a negative variance");
  reply.fitness = message.fitness;
  reply.inlier_rmse_m = message.inlier_rmse_m;
  reply.overlap = message.overlap;
  reply.margin = message.margin;
  reply.odom_segment = message.odom_segment;
  reply.latency_ms = message.latency_ms;
  reply.request_sent_ns = message.request_sent_ns;
  reply.server_received_ns = message.server_received_ns;
  reply.server_sent_ns = message.server_sent_ns;
  reply.confidence = message.confidence;
  reply.advice = static_cast<Advice>(message.advice);  // a newer server may know more of them, too
  const Status numbers =
      all_of(stamp_of(message.stamp_ns, "stamp_ns"), stamp_of(message.gpc_stamp_ns, "gpc_stamp_ns"),
             stamp_of(message.request_sent_ns, "request_sent_ns"),
             stamp_of(message.server_received_ns, "server_received_ns"),
             stamp_of(message.server_sent_ns, "server_sent_ns"), finite(message.fitness, "fitness", 0, 1),
             finite(message.inlier_rmse_m, "inlier_rmse_m", 0, 1e3), finite(message.overlap, "overlap", 0, 1),
             finite(message.margin, "margin", -1e6, 1e6), finite(message.latency_ms, "latency_ms", 0, 1e9),
             finite(message.confidence, "confidence", 0, 1));
  if (!numbers) return tl::unexpected(numbers.error());
  const Status poses =
      all_of(read_pose(message.has_T_map_sensor, message.T_map_sensor, "T_map_sensor", reply.T_map_sensor),
             read_pose(message.has_T_map_odom, message.T_map_odom, "T_map_odom", reply.T_map_odom));
  if (!poses) return tl::unexpected(poses.error());
  return reply;
}

}  // namespace liloc::wire
