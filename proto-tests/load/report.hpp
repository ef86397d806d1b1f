#pragma once
// What a run came to.
#include <optional>
#include <string>
#include <vector>

#include "proto-tests/load/outcome.hpp"

namespace liloc::load {

struct LoadReport {
  int clients = 0;
  double seconds = 0;
  std::size_t planned = 0, sent = 0, answered = 0, verified = 0, provisional = 0, refused = 0, superseded = 0,
              unanswered = 0, wrong_verified = 0;
  double availability = 0;  ///< share of client-seconds with a verified pose younger than two intervals
  /// From the planned time to the reply; one that never came counts with the client's timeout.
  double p50_ms = 0, p95_ms = 0, p99_ms = 0, p999_ms = 0, max_ms = 0;
  double tracked_p99_ms = 0;  ///< of devices that had not lost their way
  std::size_t lost = 0, found_again = 0;
  double found_again_p50_s = 0, found_again_max_s = 0;  ///< of those that were
  std::optional<double> server_cpu_s, server_rss_mb;    ///< of a server that this run started
  double rx_mb = 0, tx_mb = 0;                          ///< payload that went to the server, and replies
  double lag_ms_p99 = 0, generator_cpu_s = 0;
  bool valid = false;
  std::string why;  ///< not valid
};

constexpr double kMostLag_ms = 5;  ///< of the generator at p99: with more it measures itself

/// Fills what follows from requests and devices; `rx_mb` without the ceiling.
[[nodiscard]] LoadReport summarize(int clients, double seconds, const Outcomes& outcomes);

/// One object for one run, else an array of them.
[[nodiscard]] std::string to_json(const std::vector<LoadReport>& reports);
[[nodiscard]] std::string to_table(const std::vector<LoadReport>& reports);

}  // namespace liloc::load
