#pragma once
// What a run came to, and whether anything grew.
#include <string>
#include <vector>

#include "proto-tests/soak/growth.hpp"
#include "proto-tests/soak/visitors.hpp"

namespace liloc::soak {

/// A process by its samples.
struct Watched {
  std::string name;
  double most_memory_mb = 0;  ///< that it may grow by
  std::vector<Sample> memory_mb, threads, descriptors;
};

struct ProcessReport {
  std::string name;
  double most_memory_mb = 0;  ///< that it may grow by
  Trend memory_mb, threads, descriptors;
};

struct SoakReport {
  double seconds = 0, judged_from_s = 0;
  std::vector<ProcessReport> processes;
  std::uint64_t flaps = 0, answered = 0;  ///< by the server that stays
  int restarts = 0, silent_restarts = 0;
  std::size_t visits = 0;
  /// Of the visits that were long enough: how many there were, and the share that was located; of all that were
  /// judged, and of those in the last third.
  std::size_t long_visits = 0, last_long_visits = 0;
  double located_share = 0, last_located_share = 0;
  double log_kb_per_min = 0;          ///< of the server that stays
  bool judged = false;                ///< long enough to tell whether anything grows
  std::vector<std::string> failures;  ///< one line each; empty: all worked and, where judged, nothing grew
};

/// A third that is shorter need not hold a restart of the standby and the tape to and fro, as they are by
/// default, so that floors tell nothing. By hand; thirds of a run of kJudged_s last 60 s.
constexpr double kLeastThird_s = 50, kJudged_s = 240;
/// May have grown by so many between the first third and the last: Cyclone opens a descriptor more where two
/// participants are made at one moment. A leak of one a visit or restart is over it within minutes.
constexpr double kMostThreads = 2, kMostDescriptors = 2;
/// A visit that lasts so long is located; by hand: devices are within 3 s, after a second to be discovered.
constexpr double kLongVisit_s = 8;
/// Of long visits at least so many are; by hand: LiDARs flap, and people stand in the way.
constexpr double kLeastLocated = 0.5;
/// About what the limits on lines let through at worst: 16 in 5 s of 100 bytes each.
constexpr double kMostLogKbPerMin = 20;

[[nodiscard]] ProcessReport summarize(const Watched& watched, double from_s);
/// Fills visits and shares.
void add_visits(const std::vector<Visit>& visits, SoakReport& report);
/// Fills `judged` and `failures`.
void judge(SoakReport& report);

[[nodiscard]] std::string to_json(const SoakReport& report);
[[nodiscard]] std::string to_table(const SoakReport& report);
/// A row a sample and process.
[[nodiscard]] std::string samples_csv(const std::vector<Watched>& watched);
[[nodiscard]] std::string visits_csv(const std::vector<Visit>& visits);

}  // namespace liloc::soak
