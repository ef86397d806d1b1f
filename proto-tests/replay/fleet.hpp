#pragma once
// One server and some clients as child processes on a DDS domain of their own.
#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "proto-tests/replay/processes.hpp"

namespace liloc::replay {

struct ClientCommand {
  std::string id;
  std::filesystem::path device_file;   ///< its device.json
  std::filesystem::path trace_folder;  ///< made if need be; client.log lies there too
  std::vector<std::string> arguments;  ///< further ones
};

struct FleetCommand {
  std::filesystem::path programs;  ///< folder of liloc-server and liloc-client
  int domain = 0;
  std::filesystem::path site_file, server_log;
  std::vector<std::string> server_arguments;
  std::vector<ClientCommand> clients;
};

/// The processes end with this object, on every way out.
class Fleet {
 public:
  [[nodiscard]] static Result<Fleet> start(const FleetCommand& command);

  /// Error: one of them has ended; the message carries its last log lines.
  [[nodiscard]] Status check();
  /// Waits until `ready`, checking the processes meanwhile. Errors: one ended, the time is over, a stop signal.
  [[nodiscard]] Status wait_until(const std::function<bool()>& ready, std::chrono::milliseconds limit,
                                  std::string_view what);
  /// Clients first, so that their last traces are written while the server still stands; then the server.
  [[nodiscard]] Status stop();
  /// Of the clients, in the command's order; empty before `stop`.
  [[nodiscard]] const std::vector<Child::Usage>& client_usage() const { return client_usage_; }

 private:
  std::vector<Child> clients_;
  std::vector<Child::Usage> client_usage_;
  std::vector<Child> server_;  ///< one, or none once stopped
};

}  // namespace liloc::replay
