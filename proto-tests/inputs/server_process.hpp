#pragma once
// A server as it is installed, and what it tells.
#include <mutex>

#include "common/wire/spots/status.hpp"
#include "proto-tests/replay/processes.hpp"

namespace liloc::inputs {

class ServerProcess {
 public:
  /// Starts it in the domain and joins that to listen. Errors: the program, a port, DDS.
  [[nodiscard]] static Result<std::unique_ptr<ServerProcess>> start(int domain,
                                                                    const std::filesystem::path& site_file,
                                                                    const std::filesystem::path& log_file);

  /// The newest status; empty before the first.
  [[nodiscard]] std::optional<wire::ServerStatus> status() const;
  /// Of a LiDAR, by its place in the site; waiting before the first status.
  [[nodiscard]] wire::LidarHealth lidar(std::size_t index) const;
  /// The text of /metrics or another page of its web server.
  [[nodiscard]] std::string page(const std::string& path) const;
  /// Most memory that it had resident so far.
  [[nodiscard]] double peak_mb() const;
  [[nodiscard]] bool running() { return child_->running(); }

 private:
  ServerProcess() = default;
  int metrics_port_ = 0;
  std::optional<replay::Child> child_;
  mutable std::mutex mutex_;
  std::optional<wire::ServerStatus> status_;
  std::optional<wire::Participant> seat_;
  std::unique_ptr<wire::Dispatcher> dispatcher_;  ///< last: its thread calls the above
};

}  // namespace liloc::inputs
