#pragma once
#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "common/protocol/spot.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct ServiceOptions {
  std::string server_id = "liloc";
  int workers = 1;                ///< requests worked on at once; 1..64
  std::size_t queue = 64;         ///< requests waiting; 1..4096. When it is full strangers are refused first
  double max_rate_hz = 20;        ///< per identity; a burst of one second's worth passes
  std::size_t max_clients = 512;  ///< 1..4096
  std::chrono::milliseconds hold{100};  ///< how long a request waits for the ceiling to catch up; 0: never
  [[nodiscard]] Result<ServiceOptions> validated() const;  ///< the error names the field and its range
};

/// Where a request's time goes. hold: until the ceiling has caught up, of those that wait for it. wait: from
/// its arrival to a worker, hold included. work: in the localizer.
enum class Stage : std::uint8_t { hold, wait, work };

/// What the service puts its requests to. `locate` runs on worker threads side by side; the others on the
/// dispatcher's thread.
struct ServiceBackend {
  std::function<SpotReply(const SpotRequest&)> locate = {};
  std::function<void(const std::string& client_id)> forget = {};  ///< the client left or began anew
  /// A run of a client asks here for the first time; after `forget`, before `locate`. On the dispatcher's
  /// thread.
  std::function<void(const std::string& client_id, std::uint64_t session)> begin = {};
  /// `locate` has answered a request of this run; on the worker's thread, before the next of the client.
  std::function<void(const std::string& client_id, std::uint64_t session)> on_located = {};
  /// What the ceiling's clock showed at a time, 0 where nobody knows; any thread. Empty: never known.
  std::function<StampNs(std::chrono::steady_clock::time_point)> ceiling_now = {};
  /// For metrics, from any of the service's threads: quick, and safe to call side by side. May be empty.
  std::function<void(Stage, double seconds)> on_stage = {};
  std::function<void(const SpotReply&)> on_answer = {};  ///< the same, before each reply leaves
  /// Up to which stamp requests need not wait for the ceiling; empty where nothing is waited for. Any thread,
  /// under no lock. Empty: never waited for.
  std::function<std::optional<StampNs>()> seen_until = {};
};

}  // namespace liloc
