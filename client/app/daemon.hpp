#pragma once
#include <functional>
#include <memory>
#include <optional>

#include "client/app/options.hpp"
#include "client/app/ros_bridge.hpp"
#include "client/app/sensor_feed.hpp"
#include "common/wire/dds/address_watch.hpp"
#include "common/wire/dds/dispatcher.hpp"

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

  /// To be asked twice a second. Error: the interface's address has changed (AddressWatch). The sensors hold
  /// the domain, so that the client cannot join it anew: the daemon has to be started again.
  [[nodiscard]] Status check_address();
  /// One line for the log: state, rates, latencies.
  [[nodiscard]] std::string summary() const;
  /// First the sensors fall silent, then the client finishes what it has and writes its trace. Idempotent.
  [[nodiscard]] Status stop();

 private:
  explicit Daemon(DaemonOptions options);
  [[nodiscard]] Status join();
  [[nodiscard]] Status find_camera(const std::function<bool()>& give_up);
  [[nodiscard]] Status open_client();
  [[nodiscard]] Status subscribe();
  void diagnose();

  DaemonOptions options_;
  wire::AddressWatch addresses_;
  bool reached_ = false;  ///< a server was
  std::optional<wire::Participant> participant_;
  std::unique_ptr<RosBridge> ros_;
  std::unique_ptr<client::Client> client_;
  std::unique_ptr<SensorFeed> feed_;
  std::unique_ptr<wire::Dispatcher> sensors_;  ///< its thread calls the above: it goes first
  std::uint64_t frames_diagnosed_ = 0;
};

}  // namespace liloc
