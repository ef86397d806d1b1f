#pragma once
// Messages with every field set, for tests.
#include "common/protocol/spot.hpp"
#include "common/wire/dds/tests/sample_pose.hpp"
#include "common/wire/spots/status.hpp"

namespace liloc::wire {

inline SpotRequest sample_request(const std::string& client_id = "robot1", std::uint64_t seq = 7) {
  SpotRequest r;
  r.client_id = client_id;
  r.seq = seq;
  r.stamp_ns = 1'700'000'000'123'456'789;
  r.odom_segment = 3;
  r.T_odom_sensor = sample_pose(1);
  r.local_poses = {{r.stamp_ns - 2, sample_pose(0.25), false}, {r.stamp_ns, sample_pose(0.5), true}};
  r.lpc = {CloudCodec::draco, {1, 2, 3, 4, 5}};
  r.view = {{320, 240, 228.5, 230.5, 159.5, 119.5, 0.001}, 0.25, 8.5};
  r.up_sensor = Eigen::Vector3d(0, -1, 0);
  r.cold = true;
  r.ceiling_stamp_ns = r.stamp_ns - 0x10;
  r.sent_ns = r.stamp_ns + 0x20;
  r.extra = {CloudCodec::draco, {9, 8, 7}};
  return r;
}

inline SpotReply sample_reply(const SpotRequest& request = sample_request()) {
  SpotReply r = refusal(request, Reason::confirmed, "three spots agree");
  r.status = SpotStatus::verified;
  r.gpc_stamp_ns = request.stamp_ns + 5;
  r.T_map_sensor = sample_pose(4);
  r.covariance = Matrix6d::Identity() * 0.25;
  r.covariance(0, 5) = 0.125;
  r.fitness = 0.5;
  r.inlier_rmse_m = 0.03125;
  r.overlap = 0.75;
  r.margin = 0.25;
  r.confidence = 0.75;
  r.advice = Advice::twin;
  r.T_map_odom = sample_pose(8);
  r.latency_ms = 12.5;
  r.server_id = "edge1";
  r.server_received_ns = request.stamp_ns + 0x30;
  r.server_sent_ns = request.stamp_ns + 0x40;
  return r;
}

inline ServerStatus sample_status() {
  return {"edge1", 1,
          2.5,     {{"ceiling0", LidarState::slow, 3.5, 4, 5, "step", 0.5, 2, 4, -0.25, true}},
          6,       7,
          8,       9,
          10,      {CloudCodec::draco, CloudCodec::voxel}};
}

}  // namespace liloc::wire
