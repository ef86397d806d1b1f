#pragma once
// LiLoc for a robot: push depth frames and, where there is an IMU, its samples; read the pose.
//
//   liloc::client::Options options;
//   options.id = "robot1";
//   options.camera = {640, 480, 460.0, 460.0, 319.5, 239.5, 0.00025};
//   auto made = liloc::client::Client::create(options);
//   if (!made) { puts(made.error().c_str()); return 1; }
//   liloc::client::Client& client = *made.value();
//   // from the driver's callback; returns at once:
//   if (auto taken = client.push_depth(units, 640, 480, stamp_ns); !taken) puts(taken.error().c_str());
//   if (auto pose = client.newest(); pose.T_map_sensor) drive(*pose.T_map_sensor);
//
// Metres and radians; stamps are nanoseconds of the device's clock. Optical frame: x right, y down, z forward.
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace liloc::client {

/// A value or, where there is none, one line that says what is wrong and how to mend it.
template <class T>
class [[nodiscard]] Outcome {
 public:
  Outcome(T value) : value_(std::move(value)) {}  // NOLINT(google-explicit-constructor): reads like the value
  [[nodiscard]] static Outcome failed(std::string error) {
    Outcome outcome;
    outcome.error_ = std::move(error);
    return outcome;
  }
  explicit operator bool() const { return value_.has_value(); }
  [[nodiscard]] T& value() { return *value_; }                       ///< only where there is one
  [[nodiscard]] const std::string& error() const { return error_; }  ///< empty where there is a value

 private:
  Outcome() = default;
  std::optional<T> value_;
  std::string error_;
};

/// Taken, or an error.
struct Taken {};

struct Camera {
  int width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;
  double depth_scale_m = 0.001;  ///< metres per unit of a depth image
};

/// p_to = T_to_from * p_from.
struct Pose {
  std::array<double, 3> translation_m{0, 0, 0};
  std::array<double, 4> rotation_xyzw{0, 0, 0, 1};
};

/// external: the odometry is somebody else's (`push_odometry`); the device registers nothing by itself.
enum class Local { cloud, inertial, dead_reckoning, external };

/// How a request's clouds travel. A server that does not read it gets another that it does.
/// draco: 7 to 8 kB a frame at 1.5 mm RMSE. voxel, for thin links: 5 to 7 kB at 1.5 mm. octree, for comparison:
/// 7 to 8 kB at 5 to 11 mm.
enum class Codec { draco = 1, octree = 2, voxel = 3 };

/// Every default works in an office; they are by hand where nothing else is said. New fields go last.
struct Options {
  std::string id;  ///< 1..63 of [A-Za-z0-9_-]; one run at a time per id
  Camera camera;
  int domain = 0;                        ///< DDS domain, 0..230
  std::string network_interface = "lo";  ///< name, address or "auto"; "lo" reaches a server on this host
  std::vector<std::string> peers;        ///< hosts of the server; empty: this host
  double min_range_m = 0.25, max_range_m = 8.5;
  double voxel_size_m = 0.05;   ///< 0.01..0.5
  int interval_ms = 800;        ///< upper bound between global registrations, 50..60000 (paper, section 7.2)
  int reply_timeout_ms = 4000;  ///< a request without an answer for so long counts as unanswered
  Local local = Local::cloud;
  std::optional<Pose> T_imu_sensor;  ///< there is an IMU exactly where this is set
  double still_seconds = 0;          ///< the device stands still for so long at the start (IMU calibration)
  bool cold = false;                 ///< each request is answered on its own: no prior, no history
  std::uint64_t seed = 1;
  std::size_t queue_frames = 4;       ///< depth frames that may wait; the oldest is dropped for the newest
  std::string trace_folder;           ///< online.tum, trajectory.tum, spots.csv, local.csv; empty: none
  std::optional<Pose> T_base_sensor;  ///< with external odometry: the sensor on what the odometry moves
  bool submap = true;                 ///< requests carry what stands around as well (about 3 kB), unless `cold`
  double cpu_share = 1;               ///< of one core, 0.02..1; frames are left out to keep it
  /// Most bytes of a request's clouds, 2000..60000; the surroundings give way first, then the frame is thinned.
  std::size_t request_bytes = 15'000;
  /// Lower bound between global registrations while nothing is verified, 0..60000; 0: a quarter of interval_ms.
  /// An answer then brings the next request forward; not under interval_ms: it does not.
  int searching_interval_ms = 0;
  /// Standard deviations of the pose beyond which the state is `lost`, 0.01..100 m and 0.1..180 degrees. By
  /// default what the method's paper counts as a wrong pose.
  double lost_sd_m = 0.3, lost_sd_deg = 10;
  Codec codec = Codec::draco;
  /// What the frames come from, named where none arrive: a topic. Empty: the program's calls.
  std::string frames_from;
  /// Folder of deploy/credentials for this id, at a locked site: traffic is encrypted, and only with those who
  /// have theirs of the same keystore. Empty: none.
  std::string credentials;
};

/// searching: never located. tracking: located, the server answers. coasting: located once, and carried on by
/// the device alone because the server is silent or cannot answer. lost: located once, but the pose's standard
/// deviation exceeds Options::lost_sd_m or lost_sd_deg, or the inputs contradict each other, or no frame was
/// taken for two seconds or the newest three were refused; the pose is told on.
enum class State { searching, tracking, coasting, lost };

struct PoseUpdate {
  std::int64_t stamp_ns = 0;         ///< of the frame; 0 before the first
  std::optional<Pose> T_map_sensor;  ///< once an answer was verified
  Pose T_odom_sensor;                ///< smooth; corrections do not move it (REP-105)
  std::uint32_t odom_segment = 0;    ///< rises when the odometry broke
  bool informative = false;          ///< the frame showed enough to be matched
  bool converged = false;            ///< its pose was measured, and continues the one before it
  State state = State::searching;
  bool server_connected = false;
  /// Share of a motion along each axis of the sensor that the frame showed, [rotation; translation], 0..1:
  /// beside a bare wall it is near 0 along the wall, and the pose follows the prediction there. All 0 for a
  /// guess, and with Local::external.
  std::array<double, 6> observed{};
  /// Of T_map_sensor, row-major, sensor frame, [rad; m]: that of the last verified answer, carried on by what
  /// the odometry may have erred since. All 0 where there is no T_map_sensor.
  std::array<double, 36> covariance{};
};

struct Reply {
  std::int64_t stamp_ns = 0;  ///< of the frame that was asked about
  bool verified = false;
  std::string status, reason, text;     ///< as in spots.csv; `text` is for people
  std::optional<Pose> T_map_sensor;     ///< the server's own best answer for that frame
  std::array<double, 36> covariance{};  ///< of T_map_sensor, row-major, sensor frame, [rad; m]
  double latency_ms = 0;                ///< on the server
  /// Probability that T_map_sensor is within 10 degrees and 0.3 m of the truth; `verified` is a threshold on
  /// it.
  double confidence = 0;
  std::string advice;  ///< what would help where it is not verified: wait, turn_around, move_on, more_coverage,
                       ///< twin or clear_view; none where nothing would
};

struct Stats {
  std::uint64_t frames = 0;          ///< processed
  std::uint64_t frames_dropped = 0;  ///< the queue was full
  std::uint64_t frames_refused = 0;  ///< unreadable, wrong size, a stamp not newer, far off or in another unit
  std::uint64_t frames_uninformative = 0;
  std::uint64_t imu_refused = 0;
  std::uint64_t requests = 0, requests_unsent = 0, requests_unanswered = 0;
  std::uint64_t replies = 0, replies_verified = 0, replies_refused = 0;
  double frame_ms_median = 0, frame_ms_p99 = 0;  ///< over the last 512 frames
  std::uint64_t frames_skipped = 0;              ///< left out because the computer, or its share, is too small
  std::uint64_t odometry_refused = 0;
  double cpu_s = 0;  ///< CPU time of the registration so far
  /// How far the device's clock runs ahead of the ceiling's, by the frames' stamps and the exchanges with the
  /// server. `clock_good`: known well enough to be used where it matters.
  double clock_offset_ms = 0, clock_round_trip_ms = 0;
  bool clock_good = false;
  std::uint64_t clock_jumps = 0;  ///< a clock was set; what was learned of it is forgotten
  std::string problem;            ///< what is wrong with the input now, for people; empty: nothing was noticed
  double localized_s = 0;  ///< of the device's time, with a global pose; cpu_s over it is what a second costs
};

/// Called for every processed frame on the registration thread: a slow callback delays the next frame.
using PoseCallback = std::function<void(const PoseUpdate&)>;
/// Called for every reply on the network thread.
using ReplyCallback = std::function<void(const Reply&)>;
/// Called for every line of the log; any thread, which may ask any client for its stats. Level 0 debug, 1 info,
/// 2 warning, 3 error. Process-wide.
using LogCallback = std::function<void(int level, const std::string& line)>;
/// Waits for calls of the callback before, except from inside one: hold no lock that it needs.
void set_log(LogCallback callback);

/// Owns its threads (registration, sending, network). All calls are safe from any thread and none waits for the
/// network; callbacks must not call `stop` or destroy the client.
class Client {
 public:
  /// Callbacks may be empty; they may run before `create` returns. Errors name the option, or carry the
  /// transport's own text. A server that is not there is no error: the client waits for it.
  static Outcome<std::unique_ptr<Client>> create(const Options& options, PoseCallback on_pose = {},
                                                 ReplyCallback on_reply = {});
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// Stamps, of all that is pushed: a lone one far off (by over 10 s, or half a second back) is dropped; of
  /// three in a row the client takes it that the clock was set, starts a new odom_segment and says so in
  /// Stats::problem. Errors at once: not positive, or seconds, milliseconds or microseconds of this computer's
  /// time.

  /// Row-major 16-bit z-depth of the camera's size, 0 = no return; copied. Errors: the size differs from the
  /// camera's, the client was stopped.
  Outcome<Taken> push_depth(const std::uint16_t* units, int width, int height, std::int64_t stamp_ns);
  /// For drivers: a frame came that could not be read. It counts as refused, and `why` is told and is the
  /// problem until a frame is taken.
  void push_unusable(const std::string& why);
  /// IMU axes; `specific_force`: a device at rest reads +g upwards. What no such sensor measures (over 50 rad/s
  /// or 320 m/s^2) is dropped and counted. Errors: no T_imu_sensor, not finite, stopped.
  Outcome<Taken> push_imu(std::int64_t stamp_ns, const std::array<double, 3>& angular_velocity_rad_s,
                          const std::array<double, 3>& specific_force_m_s2);
  /// `xyz`: `count` points in the sensor's frame, three floats each, copied; in place of a depth image. Of the
  /// points, those within options.camera are used: give it the sensor's field of view and about as many pixels
  /// as it has points there. Errors: a null pointer, over 4 million points, stopped.
  Outcome<Taken> push_points(const float* xyz, std::size_t count, std::int64_t stamp_ns);
  /// With Local::external: where the odometry has the base, in its own frame; often, and in order. A gap over a
  /// second or a discontinuity starts a new odom_segment. `covariance`: of the pose, row-major, [rad; m]; its
  /// growth bounds the motion's error; one that is not finite, or has a negative variance, is taken for
  /// unknown. Errors: another method, a pose that is not finite or no rotation, stopped.
  Outcome<Taken> push_odometry(std::int64_t stamp_ns, const Pose& T_odom_base,
                               const std::optional<std::array<double, 36>>& covariance = {});

  /// Of the newest processed frame.
  [[nodiscard]] PoseUpdate newest() const;
  [[nodiscard]] Stats stats() const;

  /// Takes no more frames, finishes those that wait, sends what is due, writes the trace. Idempotent. The error
  /// is the trace's.
  Outcome<Taken> stop();

 private:
  struct Impl;
  explicit Client(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace liloc::client
