#pragma once
// What a device asks and what the server answers, as domain types: no DDS, no Draco. common/wire carries them.
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/stamp.hpp"
#include "common/geometry/camera.hpp"
#include "common/geometry/pose.hpp"

namespace liloc {

/// Raised when a message changes its meaning; a server answers other versions with Reason::protocol_version.
constexpr std::uint16_t kProtocolVersion = 2;

/// A device asks at least so often (paper, section 7.2, Table 5).
constexpr StampNs kRequestInterval = from_ms(800);

/// How a cloud travels. Ids are added, never reused.
enum class CloudCodec : std::uint8_t { draco = 1, octree = 2, voxel = 3 };
/// In the order in which a client tries them.
constexpr std::array<CloudCodec, 3> kCloudCodecs{CloudCodec::draco, CloudCodec::voxel, CloudCodec::octree};
[[nodiscard]] std::string_view name_of(CloudCodec codec);
/// By its name; empty where there is none of that name.
[[nodiscard]] std::optional<CloudCodec> codec_from(std::string_view name);

/// A compressed cloud in the sensor frame.
struct EncodedCloud {
  CloudCodec codec = CloudCodec::draco;
  std::vector<std::uint8_t> bytes;
};

/// What the device's depth sensor can see, from which the server rebuilds its view for the free-space check.
struct SensorView {
  Camera camera;
  double min_range_m = 0.25, max_range_m = 8.5;
};

/// One step of the device's odometry. Poses of one segment are consistent; a broken odometry starts a new one.
struct LocalPose {
  StampNs stamp_ns = 0;
  Pose T_odom_sensor = Pose::Identity();
  bool informative = true;
};

/// "Where am I?", asked every `kRequestInterval`: the LPC of one frame and how the device moved since the last
/// request.
struct SpotRequest {
  std::string client_id;
  std::uint64_t seq = 0;           ///< rises by one per request of a client session
  StampNs stamp_ns = 0;            ///< of the frame, device clock
  std::uint32_t odom_segment = 0;  ///< poses of other segments say nothing about this one
  Pose T_odom_sensor = Pose::Identity();
  /// Uncertainty of the motion since the previous request (one standard deviation).
  double odom_sd_rad = 0.01, odom_sd_m = 0.02;
  std::vector<LocalPose> local_poses;  ///< since the previous request, oldest first; may be empty
  EncodedCloud lpc;                    ///< sensor frame at `stamp_ns`
  double voxel_size_m = 0.05;
  SensorView view;
  /// Unit vector against gravity in sensor axes, where the device knows it, and its uncertainty.
  std::optional<Eigen::Vector3d> up_sensor;
  double up_sd_rad = 0.02;
  bool cold = false;             ///< answer this request on its own: no prior, no history
  StampNs ceiling_stamp_ns = 0;  ///< of the frame by the ceiling's clock; 0: not known, stamp_ns counts
  StampNs sent_ns = 0;           ///< when it left, device clock; 0: not known
  /// Surfaces that the device saw shortly before, outside the frame's view, by its odometry in the sensor frame
  /// at `stamp_ns`; about one point per two voxels. They say nothing of what the frame looks through. May be
  /// empty.
  EncodedCloud extra;

  /// By which the global cloud is chosen.
  [[nodiscard]] StampNs match_stamp_ns() const { return ceiling_stamp_ns != 0 ? ceiling_stamp_ns : stamp_ns; }
};

enum class SpotStatus : std::uint8_t { verified = 1, provisional = 2, refused = 3 };

/// Why a reply is what it is. Ids are added, never reused. With the paper's verification (`--verify paper`)
/// `confirmed`: at least two of its three checks hold, or one that this spot is part of; `corrected`: one
/// holds, and this spot is the odd one; `awaiting_spots`: fewer than three spots; `inconsistent`: no check
/// holds. With
/// `--verify none` every pose that is found is `confirmed`.
enum class Reason : std::uint8_t {
  none = 0,             ///< not decided yet; no server sends it
  confirmed = 1,        ///< verified: this spot's search led there too, or the pose followed so far holds on
  conclusive = 2,       ///< verified: by the first search of its segment alone, or cold
  corrected = 3,        ///< verified: elsewhere than this spot's own search, or than the pose followed so far
  awaiting_spots = 10,  ///< provisional: few searches so far and nothing else is amiss; or cold
  ambiguous = 11,       ///< provisional: this spot's search led to the likeliest place; not likely enough
  inconsistent = 12,    ///< provisional: the same, but this spot's search led elsewhere; see the advice for why
  weak = 13,            ///< provisional: of a pose that was verified before, which is in doubt by now
  no_gpc = 20,          ///< refused: no ceiling frame within 100 ms of the request's stamp
  not_found = 21,       ///< refused: no pose fits, or the server failed
  superseded = 22,      ///< refused: a newer request of the same client took its place, or the client left
  overloaded = 23,      ///< refused: the queue was full and this was its oldest; or a search took too long
  late = 24,            ///< refused: a request as new as this was answered already
  bad_request = 25,     ///< refused: a value out of range; `text` names it
  bad_cloud = 26,       ///< refused: the LPC could not be decoded, or has too few points
  protocol_version = 27,  ///< refused: client and server speak different versions
  identity = 28,          ///< refused: client_id is not the one bound to the sender's partition
  rate_limit = 29,        ///< refused: the client asks more often than the server allows (`--max-rate`)
  shutting_down = 30,     ///< refused: the server stops
  no_answer = 31,         ///< set by a client whose request timed out
};

/// What would help where an answer is not verified. Ids are added, never reused.
enum class Advice : std::uint8_t {
  none = 0,
  wait = 1,           ///< few spots so far: more of the same will do
  turn_around = 2,    ///< the ceiling sees little of what is in view, or it hardly holds a pose: look elsewhere
  move_on = 3,        ///< what can be seen from here fits no place, or none distinctly enough
  more_coverage = 4,  ///< over three searches or more the ceiling sees little of it: it does not see this place
  twin = 5,           ///< another place of the room looks alike; `text` says which
  clear_view = 6,     ///< lines of sight are contradicted: people close by, or a calibration that is off
};

[[nodiscard]] std::string_view name_of(SpotStatus status);
[[nodiscard]] std::string_view name_of(Advice advice);
[[nodiscard]] std::string_view name_of(Reason reason);

struct SpotReply {
  std::string client_id;
  std::uint64_t seq = 0;
  StampNs stamp_ns = 0;      ///< the request's
  StampNs gpc_stamp_ns = 0;  ///< of the snapshot used, server clock; 0 when there is none
  SpotStatus status = SpotStatus::refused;
  Reason reason = Reason::none;
  std::string text;                        ///< for people; at most 200 characters
  std::optional<Pose> T_map_sensor;        ///< the spot's own best answer; empty when there is none
  Matrix6d covariance = Matrix6d::Zero();  ///< of T_map_sensor, sensor frame, [rad; m]
  double fitness = 0;                      ///< share of LPC points with a GPC point within one voxel
  double inlier_rmse_m = 0;                ///< over those
  double overlap = 0;  ///< share of LPC points in space that the ceiling sees and that agree, of those seen
  double margin = 0;   ///< score over the best distinct runner-up's, 0..1; 0 where the room was not searched
  /// Probability that T_map_sensor is within 10 degrees and 0.3 m of the truth; verified is a threshold on it.
  double confidence = 0;
  Advice advice = Advice::none;
  /// Where odometry lies in the map, as far as all spots of the segment tell; set when verified.
  std::optional<Pose> T_map_odom;
  std::uint32_t odom_segment = 0;
  double latency_ms = 0;  ///< from the request's arrival to this answer, server side
  std::string server_id;
  StampNs request_sent_ns = 0;  ///< the request's, device clock
  /// When it came and when this left, by the ceiling's clock: its newest stamps plus the time since; 0: not
  /// known.
  StampNs server_received_ns = 0, server_sent_ns = 0;

  [[nodiscard]] bool verified() const { return status == SpotStatus::verified; }
};

[[nodiscard]] SpotReply refusal(const SpotRequest& request, Reason reason, std::string text);

}  // namespace liloc
