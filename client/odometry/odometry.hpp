#pragma once

#include "client/odometry/local_method.hpp"
#include "client/odometry/motion_model.hpp"
#include "client/odometry/pose_source.hpp"
#include "client/odometry/standing_view.hpp"
#include "common/base/line_limit.hpp"

namespace liloc {

class MatchCheck;

/// Defaults are by hand where nothing else is said.
struct OdometryOptions {
  LocalMethod method = LocalMethod::cloud;
  Camera camera;  ///< of the images given to `step`
  double max_range_m = 8.5;
  std::optional<Pose> T_imu_sensor;
  double cell_m = 0.10;
  StampNs coast_ns =
      from_ms(2000);  ///< longest stretch over which the guess moves on; half of it without an IMU
  StampNs give_up_ns = from_ms(700);  ///< of usable frames that fit nothing, after which a new segment starts
  StampNs bridge_ns = from_ms(5000);  ///< longest stretch without sight that is bridged at all
  double min_overlap = 0.25;          ///< of the frame with the map, below which a match is not believed
  double min_overlap_lost = 0.25;     ///< the same where no guess speaks for the match, but the view agrees:
  double max_refuted_share = 0.18;    ///< of the map in view that the image may look through
  StampNs recover_ns = from_ms(300);  ///< between two attempts to find the place by features
  double discontinuity_m = 0.03;      ///< correction after a stretch without sight that is marked
  double keyframe_m = 0.05, keyframe_rad = 0.035;
  StampNs keyframe_ns = from_ms(300);  ///< motion or time since the last keyframe that makes the next one
  std::uint64_t seed = 1;
};

/// What the odometry says of a frame.
struct OdometryStep {
  Pose T_odom_sensor = Pose::Identity();
  PoseSource source = PoseSource::guess;
  bool converged = true;       ///< the pose was measured
  bool doubtful = false;       ///< but may follow somebody who walks, or be one place of several
  bool discontinuous = false;  ///< and sight, after a stretch without, corrected what had been guessed
  std::uint32_t segment = 0;
  double overlap = 0;     ///< of the match; 0 for a guess
  double residual_m = 0;  ///< of the match, root mean square; 0 for a guess
  /// Share of a motion along each axis of the sensor that the scene showed, [rotation; translation], 0 (the
  /// pose follows the guess) .. 1; ScanMatch::observed.
  Vector6d observed = Vector6d::Zero();
  double strain = 0;            ///< between IMU and registration (InertialFilter::strain); 0 without
  double sd_rad = 0, sd_m = 0;  ///< of the motion since the last `mark`, along the axis that is known least
};

/// Local registration: each frame against the map of the device's surroundings, from a guess by the IMU or by
/// constant velocity; by features (FPFH, RANSAC) where that fails. Where the scene is hidden the guess carries
/// on for a bounded time; longer gaps start a new segment with an empty map. Not thread-safe.
class Odometry {
 public:
  explicit Odometry(const OdometryOptions& options);

  /// `usable`: the frame may be matched (not blocked). `imu` is null where there is none to believe.
  [[nodiscard]] OdometryStep step(const DepthImage& image, const std::vector<Surfel>& frame, bool usable,
                                  ImuTrack* imu);
  /// The clock of the stamps was set: a new segment starts where the last frame was.
  void clock_set();
  [[nodiscard]] const LocalMap& map() const { return segment_.map; }
  /// The uncertainty of the motion is counted from the last step on.
  void mark() {
    segment_.marked = segment_.covariance;
    segment_.slipped.setZero();
  }

 private:
  /// What belongs to one segment: a new one replaces it.
  struct Segment {
    Segment(std::uint32_t number, double cell_m) : id(number), map({.cell_m = cell_m}) {}
    std::uint32_t id;
    LocalMap map;
    StampNs anchored_ns = 0;   ///< of the last matched frame
    StampNs unmatched_ns = 0;  ///< of the first usable frame since then that fits nothing; 0: none
    StampNs keyframe_ns = 0;
    Pose T_odom_keyframe = Pose::Identity();
    int stood = 0, gone = 0;  ///< frames at the reference, and frames in a row that surely are not
    StampNs stood_ns = 0;     ///< of the last frame that stood where its reference was taken
    Matrix6d covariance = Matrix6d::Zero(), marked = Matrix6d::Zero();  ///< of the last step, and at the mark
    Vector6d slipped = Vector6d::Zero();  ///< deviations that doubtful steps since then may have left for good
  };

  [[nodiscard]] std::optional<ScanMatch> match_near(const std::vector<Surfel>& frame, const MotionGuess& guess,
                                                    const MatchCheck& check, StampNs stamp_ns) const;
  /// At the reference's pose, where the view says that the device stands there.
  [[nodiscard]] std::optional<ScanMatch> stand(const DepthImage& image, const MotionGuess& guess);
  /// From the guess, and by features where that fails. A guess that its rival beats is replaced by it.
  [[nodiscard]] std::optional<ScanMatch> match(const DepthImage& image, const std::vector<Surfel>& frame,
                                               const FrameStep& from, MotionGuess& guess, OdometryStep& step);
  [[nodiscard]] std::optional<ScanMatch> match_rival(const DepthImage& image, const std::vector<Surfel>& frame,
                                                     const MotionGuess& rival, double evidence) const;
  void accept(const ScanMatch& match, const FrameStep& from, const MotionGuess& guess, ImuTrack* imu,
              OdometryStep& step);
  /// Dead reckoning: the guess is the pose.
  void reckon(const MotionGuess& guess, StampNs stamp_ns, OdometryStep& step);
  void coast(const MotionGuess& guess, const FrameStep& from, bool usable, OdometryStep& step);
  void start_segment(StampNs stamp_ns);
  void begin_anew();
  void refer(const DepthImage& image, const OdometryStep& step);
  void tell_doubt(OdometryStep& step);
  void remember(const DepthImage& image, const std::vector<Surfel>& frame, const Pose& T_odom_sensor);

  OdometryOptions options_;
  Segment segment_;
  LineLimit lost_lines_;
  MotionModel motion_;
  StandingView standing_;
  bool has_imu_ = false;                 ///< this frame
  StampNs last_ns_ = 0;                  ///< of the last frame
  StampNs recovered_ns_ = 0;             ///< of the last attempt by features
  Pose T_odom_last_ = Pose::Identity();  ///< of the last frame; a new segment goes on from there
};

}  // namespace liloc
