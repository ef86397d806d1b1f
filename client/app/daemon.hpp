#pragma once
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>

#include "client/app/options.hpp"
#include "common/geometry/camera.hpp"
#include "common/wire/dispatcher.hpp"
#include "common/wire/sensor_publishers.hpp"

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
  void take_depth(Result<DepthImage> image);
  void take_imu(const Result<ImuSample>& sample);
  void check_camera(const Camera& camera);
  void tell_ros(const client::PoseUpdate& update);
  void complain(const std::string& what);

  DaemonOptions options_;
  std::optional<wire::Participant> participant_;
  std::optional<wire::PosePublisher> ros_;
  std::mutex covariance_mutex_;
  Matrix6d covariance_ = Matrix6d::Identity();  ///< of the newest verified answer
  std::unique_ptr<client::Client> client_;
  std::unique_ptr<wire::Dispatcher> sensors_;  ///< its thread calls the client: it goes first
  std::atomic<std::uint64_t> malformed_ = 0;
  std::chrono::steady_clock::time_point complained_{};  ///< of the sensors' thread
  bool camera_differs_ = false;
};

}  // namespace liloc
