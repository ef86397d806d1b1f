#pragma once
#include "client/engine/tests/walker.hpp"
#include "common/geometry/depth.hpp"

namespace liloc::test {

enum class Inputs { depth, points, imu, external };

/// The walk, seen by a device whose stamps may be wrong, and a server that answers each request with the truth.
class Device {
 public:
  using Stamps = std::function<StampNs(StampNs)>;
  using Path = Pose (*)(double);
  explicit Device(Inputs inputs, Path path = walk)
      : inputs_(inputs), path_(path), engine(options_for(inputs)), room_(scene::furnished_room(1)) {
    imu_ = scene::imu_along(path, mounting(), 0, 45, 200, kStart);
  }

  /// Walks on for so long. The stamps are what `frame` and `sample` make of the true ones.
  void go(double seconds, const Stamps& frame_stamp, const Stamps& sample_stamp) {
    for (const double end = t_ + seconds; t_ < end; t_ += 1 / frame_hz) {
      feed_samples(sample_stamp);
      const StampNs stamp = kStart + from_seconds(t_);
      DepthImage image = scene::render(room_, path_(t_), scene::small_camera(), frame_stamp(stamp), 0.004);
      const auto frame = inputs_ == Inputs::points
                             ? engine.add_points(image.stamp_ns, *depth_to_cloud(image, scene::small_camera()))
                             : engine.add_depth(image);
      frames_refused += !frame;
      if (std::string now = engine.problem(); !now.empty()) problems += now + "\n";
      if (!frame) continue;
      frame_ = *frame;
      unlocated_s = engine.tracking() == Tracking::tracking ? 0 : unlocated_s + 1 / frame_hz;
      longest_unlocated_s = std::max(longest_unlocated_s, unlocated_s);
      if (frame->T_map_sensor && engine.tracking() == Tracking::tracking)
        worst_m = std::max(worst_m, distance_m(*frame->T_map_sensor, path_(t_)));
      ++frames;
      wrong += frame->T_map_sensor && (distance_m(*frame->T_map_sensor, path_(t_)) > 0.3 ||
                                       angle_between_rad(*frame->T_map_sensor, path_(t_)) > radians(10));
      answer();
    }
  }
  void go(double seconds, const Stamps& stamp) { go(seconds, stamp, stamp); }

 private:
  static EngineOptions options_for(Inputs inputs) {
    EngineOptions options = engine_options();
    if (inputs == Inputs::external) options.local = LocalMethod::external;
    if (inputs == Inputs::imu) options.T_imu_sensor = mounting();
    if (inputs == Inputs::imu) options.still_seconds = kStillS;
    return options;
  }
  void feed_samples(const Stamps& stamp_of_sample) {
    for (; next_ < imu_.size() && imu_[next_].stamp_ns <= kStart + from_seconds(t_); ++next_) {
      ImuSample sample = imu_[next_];
      const double t = to_seconds(sample.stamp_ns - kStart);
      sample.stamp_ns = stamp_of_sample(sample.stamp_ns);
      spoil(sample);
      if (inputs_ == Inputs::imu) samples_refused += !engine.add_imu(sample);
      if (inputs_ == Inputs::external)
        samples_refused += !engine.add_odometry({sample.stamp_ns, path_(t), covariance});
    }
  }
  void answer() {
    const auto request = engine.take_request();
    if (!request) return;
    if (request->up_sensor) {
      const Eigen::Vector3d up_sensor = path_(t_).linear().transpose() * Eigen::Vector3d::UnitZ();
      ++ups;
      wrong_ups += request->up_sensor->dot(up_sensor) < std::cos(std::max(0.03, 3 * request->up_sd_rad));
    }
    SpotReply reply;
    reply.seq = request->seq;
    reply.stamp_ns = request->stamp_ns;
    reply.odom_segment = request->odom_segment;
    reply.status = SpotStatus::verified;
    reply.T_map_odom = path_(t_) * request->T_odom_sensor.inverse();
    reply.covariance = 1e-6 * Matrix6d::Identity();
    engine.add_reply(reply);
  }

  Inputs inputs_;
  Path path_;
  double t_ = 0.05;
  std::vector<ImuSample> imu_;
  std::size_t next_ = 0;

 public:
  double frame_hz = kFrameHz;
  Engine engine;
  FrameResult frame_;
  std::function<void(ImuSample&)> spoil = [](ImuSample&) {};
  std::optional<Matrix6d> covariance;
  std::string problems;
  int frames = 0, frames_refused = 0, samples_refused = 0;
  int wrong = 0;               ///< poses off by over 0.3 m or 10 degrees, as the paper counts them
  int ups = 0, wrong_ups = 0;  ///< told with requests
  double unlocated_s = 0, longest_unlocated_s = 0, worst_m = 0;

 private:
  scene::BoxRoom room_;
};

inline StampNs right(StampNs stamp_ns) {
  return stamp_ns;
}

}  // namespace liloc::test
