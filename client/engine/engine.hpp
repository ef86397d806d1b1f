#pragma once
// The client without threads or network: frames and IMU in, poses and requests out, replies in.
// `liloc::client` runs it on its threads over DDS, `liloc replay --lockstep` calls it directly.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/engine/engine_options.hpp"
#include "client/engine/map_link.hpp"
#include "client/odometry/external_odometry.hpp"
#include "common/geometry/cloud.hpp"
#include "common/protocol/spot.hpp"

namespace liloc {

/// What a frame brought; a row of local.csv.
struct FrameResult {
  StampNs stamp_ns = 0;
  bool informative = true;
  PoseSource source = PoseSource::guess;
  bool converged = true;  ///< measured, and without a discontinuity (sight corrected what had been guessed)
  double latency_ms = 0;
  Pose T_odom_sensor = Pose::Identity();
  std::uint32_t odom_segment = 0;
  std::optional<Pose> T_map_sensor;  ///< where the device is, once an answer was verified
  double residual_m = 0;             ///< of the match with the local map; 0: none
  /// Share of a motion along each axis of the sensor that the frame showed, [rotation; translation], 0..1:
  /// beside a bare wall it is near 0 along the wall, and the pose follows the guess there. All 0 for a guess.
  Vector6d observed = Vector6d::Zero();
  std::optional<Matrix6d> covariance;  ///< of T_map_sensor, [rad; m], sensor axes: PoseDoubt
  bool clock_set_back = false;         ///< before this frame: stamps of before say nothing about it
};

/// Not thread-safe except where said; stamps rise, except where the device's clock was set (StampWatch).
class Engine {
 public:
  explicit Engine(EngineOptions options);
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  [[nodiscard]] Status add_imu(const ImuSample& sample);
  /// Errors: wrong size, a stamp that StampWatch refuses; the frame is then ignored.
  [[nodiscard]] Result<FrameResult> add_depth(const DepthImage& image);
  /// A cloud in place of an image, in the sensor frame; the camera is then the part of the view that is used,
  /// best with about as many pixels as the cloud has points. Errors: as above.
  [[nodiscard]] Result<FrameResult> add_points(StampNs stamp_ns, const Cloud& cloud_sensor);
  /// Errors: the method is not external, not finite, a stamp that StampWatch refuses.
  [[nodiscard]] Status add_odometry(const OdometrySample& sample);
  /// Clouds of the requests from the next frame on; as the options say until then.
  void encode_as(CloudCodec codec);
  /// The request that the last frame made due, if any; taken once.
  [[nodiscard]] std::optional<SpotRequest> take_request();
  /// The requests that have stayed without an answer for too long since the last call, by seq.
  [[nodiscard]] std::vector<std::uint64_t> take_unanswered();
  /// Moves map -> odom when verified. Answers of a past odometry segment are ignored.
  void add_reply(const SpotReply& reply);
  /// A server has come: the next frame that can asks it, however long ago the last request was, and others
  /// follow quickly until an answer is verified.
  void server_found();

  [[nodiscard]] std::optional<Pose> T_map_odom() const;
  [[nodiscard]] Tracking tracking() const;
  /// What is wrong with the input as of the last frame, for people; empty: nothing was noticed.
  [[nodiscard]] std::string problem() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace liloc
