#pragma once
// What a running server is asked for when its metrics or its health are read.
#include <optional>
#include <string>
#include <vector>

#include "common/wire/spots/status.hpp"
#include "server/service/request_scheduler.hpp"

namespace liloc::web {

struct LidarFacts {
  wire::LidarHealth health;
  std::optional<double> age_s;  ///< since its newest good frame came; empty before the first
};

struct ServerFacts {
  std::string server_id, version;
  double uptime_s = 0;
  double network_idle_s = 0;  ///< since the network's thread was last at work; it is so once a second
  std::size_t clients = 0;    ///< connected
  ServiceCounters service;
  std::vector<LidarFacts> lidars;
  std::uint64_t samples_lost = 0;  ///< by DDS, since the start
};

/// Of this process, as the kernel tells; 0 where it does not.
struct ProcessFacts {
  double resident_bytes = 0, cpu_s = 0, threads = 0, open_files = 0;
};
[[nodiscard]] ProcessFacts process_facts();

/// Age of the global cloud: since the newest ceiling frame of any LiDAR came. Empty before the first.
[[nodiscard]] std::optional<double> gpc_age_s(const ServerFacts& facts);

}  // namespace liloc::web
