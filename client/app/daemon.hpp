#pragma once
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "client/app/options.hpp"
#include "client/app/ros_face.hpp"
#include "common/geometry/camera.hpp"
#include "common/wire/dispatcher.hpp"
#include "common/wire/sensors.hpp"

namespace liloc {

/// A device's sensor topics on one side, the client library on the other.
class Daemon {
 public:
  /// Where the options name no camera, waits for the camera_info topic until `give_up` says so; the result is
  /// then empty. Errors carry the remedy.
  [[nodiscard]] static Result<std::unique_ptr<Daemon>> start(DaemonOptions options,
                                                             const std::function<bool()>& give_up);
  ~Daemon();
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  /// One line for the log: state, rates, latencies.
  [[nodiscard]] std::string summary() const;
  /// First the sensors fall silent, then the client finishes what it has and writes its trace. Idempotent.
  [[nodiscard]] Status stop();

 private:
  explicit Daemon(DaemonOptions options) : options_(std::move(options)) {}
  [[nodiscard]] Status join();
  [[nodiscard]] Status find_camera(const std::function<bool()>& give_up);
  [[nodiscard]] Status open_client();
  [[nodiscard]] Status subscribe();
  [[nodiscard]] Status subscribe_frames();
  void take_depth(const Result<DepthImage>& image);
  void take_points(const Result<wire::StampedCloud>& cloud);
  void take_odometry(const Result<wire::StampedOdometry>& odometry);
  void take_imu(const Result<ImuSample>& sample);
  void check_camera(const Camera& camera);
  void diagnose();
  void complain(const std::string& what);

  DaemonOptions options_;
  std::optional<wire::Participant> participant_;
  std::unique_ptr<RosFace> ros_;
  std::unique_ptr<client::Client> client_;
  std::unique_ptr<wire::Dispatcher> sensors_;  ///< its thread calls the client: it goes first
  std::atomic<std::uint64_t> malformed_ = 0;
  std::chrono::steady_clock::time_point complained_{};  ///< of the sensors' thread
  bool camera_differs_ = false, frame_differs_ = false;
  std::uint64_t frames_diagnosed_ = 0;
};

}  // namespace liloc
