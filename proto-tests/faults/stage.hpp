#pragma once
// A site to be maltreated: servers, ceiling LiDARs and a device, each a host of a network of our own.
#include <memory>
#include <optional>

#include "proto-tests/faults/bad_network.hpp"
#include "proto-tests/faults/players.hpp"
#include "proto-tests/load/forked.hpp"
#include "proto-tests/replay/processes.hpp"

namespace liloc::faults {

inline constexpr char kCeiling[] = "ceiling", kDevice[] = "device";  ///< names of hosts

/// `edge1`, `edge2`: the hosts and the ids of the servers.
[[nodiscard]] std::string server_name(std::size_t server);

struct StageOptions {
  std::filesystem::path programs, out;  ///< folder of liloc-server; an empty folder for logs
  std::size_t servers = 1;              ///< hosts of servers
  bool small_disk = false;              ///< what the servers write goes to a disk of 256 kB of its own
  std::uint64_t seed = 1;               ///< of the network
};

/// Not thread-safe: its owner's thread alone, which must live as long as it.
class Stage {
 public:
  /// Starts the first server. Errors: the system does not permit a network of our own; a program cannot be
  /// started.
  [[nodiscard]] static Result<std::unique_ptr<Stage>> open(const StageOptions& options,
                                                           const Recording& recording);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

  /// Starts the LiDARs and the device.
  [[nodiscard]] Status begin(const Performance& performance);
  /// What the device tells, once it has ended.
  [[nodiscard]] Result<DeviceStory> end();

  [[nodiscard]] BadNetwork& network() { return *network_; }
  [[nodiscard]] Status start_server(std::size_t server);
  /// SIGKILL, and gone when it returns.
  void kill_server(std::size_t server);
  void freeze_server(std::size_t server);
  void thaw_server(std::size_t server);
  /// Stops the threads that work on requests, and no other. Error: there are none, or ptrace is not permitted.
  [[nodiscard]] Status hang_workers(std::size_t server);
  void freeze_device();
  void thaw_device();
  [[nodiscard]] Status fill_disk();
  [[nodiscard]] Status change_device_address(const std::string& address);
  /// Errors: a server that was not killed has ended.
  [[nodiscard]] Status check();

 private:
  Stage(StageOptions options, const Recording& recording)
      : options_(std::move(options)),
        recording_(recording),
        servers_(options_.servers),
        hung_(options_.servers) {}
  [[nodiscard]] Status open_disk();
  [[nodiscard]] wire::DomainOptions seat(wire::Role role) const;

  const StageOptions options_;
  const Recording& recording_;
  std::unique_ptr<BadNetwork> network_;
  std::vector<std::optional<replay::Child>> servers_;  ///< none while killed
  std::vector<std::vector<pid_t>> hung_;               ///< threads of each that are stopped
  std::optional<load::Forked> ceiling_, device_;
  bool disk_ = false;
};

}  // namespace liloc::faults
