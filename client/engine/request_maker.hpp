#pragma once
#include <optional>
#include <vector>

#include "client/engine/engine_options.hpp"
#include "client/engine/pose_doubt.hpp"
#include "client/odometry/odometry.hpp"

namespace liloc {

/// Gathers what a device has to tell since its last request, the path and how sure it is of that, and makes the
/// next request of it and the newest frame. Not thread-safe.
class RequestMaker {
 public:
  explicit RequestMaker(const EngineOptions& options) : options_(options) {}

  /// To be called once for each frame whose place is known. A new segment starts the path anew.
  void travelled(StampNs stamp_ns, const OdometryStep& step, bool informative);
  /// Of the motion since the last request.
  [[nodiscard]] MotionSd motion_sd() const;
  /// From the next request on; as the options say until then.
  void encode_as(CloudCodec codec) { options_.codec = codec; }
  /// The request for the frame that travelled last: `cloud_sensor` is all it shows, `surroundings` what the
  /// device has seen around it (left out as the options say), `imu` may be null. A device that is `located`
  /// sends only surroundings that its odometry has placed well; one that is not, all it has. A frame that can
  /// be sent ends the path. Errors: those of `encode`; the path then goes on.
  [[nodiscard]] Result<SpotRequest> make(const Cloud& cloud_sensor, const LocalMap& surroundings,
                                         const ImuTrack* imu, bool located = false);

 private:
  void add_surroundings(const LocalMap& surroundings, StampNs since_ns, SpotRequest& request) const;

  /// What belongs to one segment of the odometry: poses of another say nothing about it.
  struct Segment {
    OdometryStep last;
    std::vector<LocalPose> path;        ///< since the last request
    double path_m = 0, turned_rad = 0;  ///< likewise
    StampNs unsteady_ns = 0;            ///< of the last request whose motion is not known well
  };

  EngineOptions options_;
  std::uint64_t next_seq_ = 1;
  std::optional<Segment> segment_;  ///< empty before the first frame
};

}  // namespace liloc
