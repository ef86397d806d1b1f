// Every field of the library's structures crosses the C boundary. Each structure is taken apart into as many
// names as it has fields: one more, and this does not compile.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <numeric>

#include "client/api/c_api_structs.hpp"

namespace liloc::client::c_api {
namespace {

const Pose kPose{{1, 2, 3}, {0.5, -0.5, 0.5, -0.5}};

void expect_same(const Pose& T, const liloc_pose& pose) {
  EXPECT_TRUE(std::equal(T.translation_m.begin(), T.translation_m.end(), pose.translation_m));
  EXPECT_TRUE(std::equal(T.rotation_xyzw.begin(), T.rotation_xyzw.end(), pose.rotation_xyzw));
}

TEST(CApiFields, Stats) {
  const Stats stats{
      1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18.5, true, 20, "the IMU is silent", 21};
  const auto& [frames, dropped, refused, uninformative, imu_refused, requests, unsent, unanswered, replies,
               verified, replies_refused, median, p99, skipped, odometry_refused, cpu, offset, round_trip, good,
               jumps, problem, localized] = stats;
  const liloc_stats s = to_c(stats);
  EXPECT_EQ(s.frames, frames);
  EXPECT_EQ(s.frames_dropped, dropped);
  EXPECT_EQ(s.frames_refused, refused);
  EXPECT_EQ(s.frames_uninformative, uninformative);
  EXPECT_EQ(s.imu_refused, imu_refused);
  EXPECT_EQ(s.requests, requests);
  EXPECT_EQ(s.requests_unsent, unsent);
  EXPECT_EQ(s.requests_unanswered, unanswered);
  EXPECT_EQ(s.replies, replies);
  EXPECT_EQ(s.replies_verified, verified);
  EXPECT_EQ(s.replies_refused, replies_refused);
  EXPECT_EQ(s.frame_ms_median, median);
  EXPECT_EQ(s.frame_ms_p99, p99);
  EXPECT_EQ(s.frames_skipped, skipped);
  EXPECT_EQ(s.odometry_refused, odometry_refused);
  EXPECT_EQ(s.cpu_s, cpu);
  EXPECT_EQ(s.clock_offset_ms, offset);
  EXPECT_EQ(s.clock_round_trip_ms, round_trip);
  EXPECT_EQ(s.clock_good, good);
  EXPECT_EQ(s.clock_jumps, jumps);
  EXPECT_EQ(s.problem, problem);
  EXPECT_EQ(s.localized_s, localized);
}

TEST(CApiFields, AProblemOfAnyLengthEndsWithAZero) {
  Stats stats;
  stats.problem.assign(1000, 'x');
  EXPECT_EQ(std::string(to_c(stats).problem), std::string(255, 'x'));
}

TEST(CApiFields, PoseUpdate) {
  PoseUpdate update{1,           kPose, {{4, 5, 6}, {0, 0, 0, 1}}, 2, true, true,
                    State::lost, true,  {.1, .2, .3, .4, .5, .6},  {}};
  std::iota(update.covariance.begin(), update.covariance.end(), 1.0);
  const auto& [stamp, T_map_sensor, T_odom_sensor, segment, informative, converged, state, connected, observed,
               covariance] = update;
  const liloc_pose_update u = to_c(update);
  EXPECT_EQ(u.stamp_ns, stamp);
  EXPECT_TRUE(u.has_map);
  expect_same(*T_map_sensor, u.T_map_sensor);
  expect_same(T_odom_sensor, u.T_odom_sensor);
  EXPECT_EQ(u.odom_segment, segment);
  EXPECT_EQ(u.informative, informative);
  EXPECT_EQ(u.converged, converged);
  EXPECT_EQ(u.state, static_cast<int>(state));
  EXPECT_EQ(u.server_connected, connected);
  EXPECT_TRUE(std::equal(observed.begin(), observed.end(), std::begin(u.observed), std::end(u.observed)));
  EXPECT_TRUE(
      std::equal(covariance.begin(), covariance.end(), std::begin(u.covariance), std::end(u.covariance)));
}

TEST(CApiFields, AProgramOfTheFirstReleaseGetsTheDefaultsOfWhatCameLater) {
  constexpr std::size_t kThen = kFirstSize<liloc_client_options>;
  liloc_client_options o = default_options();
  o.id = "older";
  o.request_bytes = 77;  // beyond what such a program passes
  o.searching_interval_ms = 77;
  o.lost_sd_m = 77;
  o.codec = LILOC_CODEC_OCTREE;
  o.credentials = "beyond";
  const auto options = options_from(&o, kThen);
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(options->request_bytes, Options{}.request_bytes);
  EXPECT_EQ(options->searching_interval_ms, Options{}.searching_interval_ms);
  EXPECT_EQ(options->lost_sd_m, Options{}.lost_sd_m);
  EXPECT_EQ(options->codec, Codec::draco);
  EXPECT_EQ(options->credentials, "");
  EXPECT_FALSE(options_from(&o, kThen - 1));

  liloc_pose_update u{};
  u.observed[0] = 77;
  PoseUpdate update;
  update.stamp_ns = 5;
  ASSERT_TRUE(copy_out(to_c(update), &u, kFirstSize<liloc_pose_update>, "liloc_pose_update"));
  EXPECT_EQ(u.stamp_ns, 5);
  EXPECT_EQ(u.observed[0], 77);  // not written
}

TEST(CApiFields, Options) {
  liloc_client_options o = default_options();
  const char* const peers[] = {"edge", "spare"};
  o.id = "robot";
  o.camera = {1, 2, 3, 4, 5, 6, 7};
  o.domain = 8;
  o.network_interface = "eth9";
  o.peers = peers;
  o.peer_count = 2;
  o.min_range_m = 10;
  o.max_range_m = 11;
  o.voxel_size_m = 12;
  o.interval_ms = 13;
  o.reply_timeout_ms = 14;
  o.local = LILOC_LOCAL_EXTERNAL;
  o.has_imu = o.has_base = o.cold = true;
  std::copy(kPose.translation_m.begin(), kPose.translation_m.end(), o.T_imu_sensor.translation_m);
  std::copy(kPose.rotation_xyzw.begin(), kPose.rotation_xyzw.end(), o.T_imu_sensor.rotation_xyzw);
  o.T_base_sensor = o.T_imu_sensor;
  o.still_seconds = 15;
  o.seed = 16;
  o.queue_frames = 17;
  o.trace_folder = "trace";
  o.submap = false;
  o.cpu_share = 0.5;
  o.request_bytes = 18;
  o.searching_interval_ms = 19;
  o.lost_sd_m = 0.2;
  o.lost_sd_deg = 21;
  o.codec = LILOC_CODEC_VOXEL;
  o.credentials = "keys";
  const auto options = options_from(&o, sizeof o);
  ASSERT_TRUE(options) << options.error().message;
  const auto& [id, camera, domain, interface, peer_list, min_range, max_range, voxel, interval, timeout, local,
               T_imu, still, cold, seed, queue, trace, T_base, submap, share, bytes, searching, lost_m,
               lost_deg, codec, frames_from, credentials] = *options;
  EXPECT_EQ(credentials, "keys");
  EXPECT_EQ(codec, Codec::voxel);
  EXPECT_EQ(frames_from, "");  // the calls of a program in C
  EXPECT_EQ(id + interface + trace, "roboteth9trace");
  EXPECT_EQ(camera.width + camera.height, 3);
  EXPECT_EQ(camera.fx + camera.fy + camera.cx + camera.cy + camera.depth_scale_m, 25);
  EXPECT_EQ(domain, 8);
  EXPECT_EQ(peer_list, (std::vector<std::string>{"edge", "spare"}));
  EXPECT_EQ(min_range, 10);
  EXPECT_EQ(max_range, 11);
  EXPECT_EQ(voxel, 12);
  EXPECT_EQ(interval, 13);
  EXPECT_EQ(timeout, 14);
  EXPECT_EQ(local, Local::external);
  ASSERT_TRUE(T_imu && T_base);
  expect_same(*T_imu, o.T_imu_sensor);
  expect_same(*T_base, o.T_base_sensor);
  EXPECT_EQ(still, 15);
  EXPECT_TRUE(cold);
  EXPECT_EQ(seed, 16U);
  EXPECT_EQ(queue, 17U);
  EXPECT_FALSE(submap);
  EXPECT_EQ(share, 0.5);
  EXPECT_EQ(bytes, 18U);
  EXPECT_EQ(searching, 19);
  EXPECT_EQ(lost_m, 0.2);
  EXPECT_EQ(lost_deg, 21);
}

}  // namespace
}  // namespace liloc::client::c_api
