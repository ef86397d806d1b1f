#pragma once
// Devices' engines and the server's localizer at one site, in one thread and without DDS.
#include "proto-tests/bench/spot_bench_evidence.hpp"
#include "proto-tests/bench/spot_bench_peers.hpp"
#include "proto-tests/bench/spot_bench_row.hpp"
#include "proto-tests/bench/spot_bench_sites.hpp"

namespace liloc::bench {

struct TrialOptions {
  int peer_every = 0;     ///< of so many spots one is kept for the peers; 0: none
  int threads = 1;        ///< per request
  bool gravity = true;    ///< whether requests say where up is
  bool evidence = false;  ///< gather it; all answers are then of sessions that never believe what they find
};

struct TrialResult {
  std::vector<Row> rows;              ///< a cold one, then the same spot with history
  std::vector<PeerProblem> problems;  ///< of some of them; `row` is the cold one
  std::vector<EvidenceRow> evidence;
};

/// Runs a site to its end. Each request of a device is answered twice: cold, on the frame alone, and with
/// history and surroundings, as a server answers it. Deterministic but for the latencies. Errors: those of the
/// site's frames.
[[nodiscard]] Result<TrialResult> run_trial(Stage stage, const TrialOptions& options);

}  // namespace liloc::bench
