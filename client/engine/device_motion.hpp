#pragma once
#include <optional>
#include <string>

#include "client/engine/engine_options.hpp"
#include "client/inertial/imu_trust.hpp"
#include "client/odometry/external_odometry.hpp"
#include "client/odometry/informativeness.hpp"
#include "client/odometry/odometry.hpp"
#include "common/geometry/cloud.hpp"

namespace liloc {

/// A depth frame. Views: what they look at outlives them.
struct DepthFrame {
  const DepthImage& image;
  const Cloud* points = nullptr;  ///< within the view, where the frame came as a cloud

  /// What it shows in range: `points`, or `image` as `camera` measured it. Errors: depth_to_cloud's.
  [[nodiscard]] Result<Cloud> cloud(const Camera& camera, const EngineOptions& options) const;
};

/// Where a frame was taken, and whether it can be sent.
struct Placed {
  OdometryStep step;
  bool informative = false;
  bool misfit = false;  ///< the frame shows a scene, but not that of the guess
};

/// How the device moves from frame to frame: by its own odometry, of depth and IMU, or by somebody else's. Not
/// thread-safe.
class DeviceMotion {
 public:
  explicit DeviceMotion(const EngineOptions& options);

  /// Errors: there is no IMU; ImuTrust's.
  [[nodiscard]] Status add(const ImuSample& sample);
  /// Errors: the method is not external; ExternalOdometry's.
  [[nodiscard]] Status add(const OdometrySample& sample);
  /// Errors: depth_to_cloud's.
  [[nodiscard]] Result<Placed> place(const DepthFrame& frame, const FrameSpread& spread);
  /// Holds the IMU against what the frame showed. `contradicted`: depth and predictions do so persistently.
  /// True where it is left out from now on.
  [[nodiscard]] bool judge_imu(StampNs stamp_ns, const Placed& placed, bool contradicted);
  /// The uncertainty of the motion is counted from the last frame on.
  void mark();
  /// The clock of the frames was set by so much.
  void clock_set(StampNs by_ns);

  /// The newest frame has a pose.
  [[nodiscard]] bool placed() const { return !external_ || external_->placed(); }
  /// Of what the device has seen around it.
  [[nodiscard]] const LocalMap& surroundings() const { return odometry_.map(); }
  /// The IMU, where there is one and it is believed; null otherwise.
  [[nodiscard]] const ImuTrack* imu() { return believed(); }
  /// What is wrong with what the motion is known by, for people; empty: nothing was noticed.
  [[nodiscard]] std::string problem() const;

 private:
  [[nodiscard]] ImuTrack* believed() { return imu_ ? imu_->believed() : nullptr; }
  [[nodiscard]] Placed place_external(StampNs stamp_ns, const FrameSpread& spread);

  const EngineOptions options_;
  const int thinning_;
  std::optional<ImuTrust> imu_;
  std::optional<ExternalOdometry> external_;
  Odometry odometry_;
};

}  // namespace liloc
