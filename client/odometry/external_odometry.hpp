#pragma once
#include <deque>
#include <optional>
#include <string>

#include "client/inertial/sample_stamps.hpp"
#include "client/odometry/odometry.hpp"
#include "common/base/line_limit.hpp"

namespace liloc {

/// A pose by the odometry of somebody else, in a frame of its own that no correction moves.
struct OdometrySample {
  StampNs stamp_ns = 0;
  Pose T_odom_base = Pose::Identity();
  std::optional<Matrix6d> covariance;  ///< of the pose, [rad; m]; its growth bounds the motion's error
};

/// Defaults are by hand where nothing else is said.
struct ExternalOdometryOptions {
  Pose T_base_sensor = Pose::Identity();  ///< where the depth sensor sits on what the odometry moves
  StampNs keep_ns = from_ms(10'000);      ///< memory bound
  StampNs gap_ns = from_ms(1000);         ///< without samples for longer, a new segment starts
  StampNs reach_ns = from_ms(100);        ///< how far beyond the newest sample a pose is still guessed
  double discontinuity_m = 0.05, discontinuity_rad = 0.05;  ///< a step beyond this ...
  double speed_m_s = 5, turn_rate_rad_s = 10;  ///< ... and beyond what these allow starts a new segment
};

/// Odometry that somebody else keeps (wheels, a legged robot's own estimator): poses at the frames' stamps, and
/// segments within which it holds together. Not thread-safe.
class ExternalOdometry {
 public:
  explicit ExternalOdometry(const ExternalOdometryOptions& options) : options_(options) {}

  /// A covariance that cannot be one is taken for unknown. Errors: not finite, StampWatch's; the sample is then
  /// ignored.
  [[nodiscard]] Status add(const OdometrySample& sample);
  /// Where the sensor is at a frame's stamp: `external` between two samples, a guess a little beyond the
  /// newest, or where there is none near; the pose is then the last one and `placed` is false.
  [[nodiscard]] OdometryStep step(StampNs stamp_ns);
  [[nodiscard]] bool placed() const { return placed_; }
  /// Why no segment lasts, empty where they do: the samples jump again and again.
  [[nodiscard]] std::string problem() const;
  /// The growth of the covariance is counted from the last step on.
  void mark() { marked_ = last_covariance_; }
  /// The frames' clock was set: a new segment starts.
  void frames_clock_set();

 private:
  struct Entry {
    OdometrySample sample;
    std::uint32_t segment;
  };
  [[nodiscard]] bool continues(const OdometrySample& from, const OdometrySample& to) const;
  void place(const Entry& entry, const Pose& T_odom_base, OdometryStep& step);

  void set_clock(StampNs by_ns);
  void know(OdometrySample& sample);
  void jump(const OdometrySample& from, const OdometrySample& to);

  ExternalOdometryOptions options_;
  StampWatch stamps_{{"odometry", kClosestSampleNs, kJudgedSamples}};
  std::deque<Entry> entries_;  ///< by rising stamp
  Pose T_odom_last_ = Pose::Identity();
  std::uint32_t segment_ = 0;          ///< of the newest sample
  std::uint32_t segments_before_ = 0;  ///< that ended because the frames' clock was set
  std::uint32_t last_segment_ = 0;
  bool placed_ = false;
  bool covariance_told_ = false;
  int jumps_ = 0;  ///< kJump for each, one less for each sample that goes on
  double jump_m_ = 0, jump_s_ = 0;
  LineLimit clock_lines_, jump_lines_;  ///< odometry in another unit jumps with each sample
  std::optional<Matrix6d> last_covariance_, marked_;
};

}  // namespace liloc
