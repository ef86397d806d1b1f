#pragma once
// What can go wrong at a site, one thing at a time.
#include "proto-tests/faults/stage.hpp"

namespace liloc::faults {

/// Recovery counts from `over` on; a trouble that lasts has none.
enum class Mark { none, begins, over, begins_and_over };

struct Act {
  double at_s = 0;  ///< since the start of the streams
  Mark mark = Mark::none;
  std::function<Status(Stage&)> run;
};

struct Scenario {
  std::string name, what;
  double seconds = 20;  ///< of the streams
  std::size_t servers = 1;
  bool small_disk = false;
  StreamFaults streams;
  std::vector<Act> acts;  ///< by rising time
};

/// How long the recording has to be that they play.
inline constexpr double kLongest_s = 24;

[[nodiscard]] const std::vector<Scenario>& scenarios();
/// Error: none is named so; the text names them all.
[[nodiscard]] Result<Scenario> scenario_named(const std::string& name);

/// When the trouble began and was over, as it came to pass; seconds since the start of the streams.
struct Times {
  std::optional<double> begins_s, over_s;
};

struct Performed {
  DeviceStory story;
  Times times;
  BadNetwork::Counters frames;  ///< of the device's link
};

struct PerformOptions {
  std::filesystem::path programs, out;
  std::uint64_t seed = 1;  ///< of the network, and of the moment of the fault within 0.8 s
};

/// Plays a scenario in real time. Errors: not permitted here, a program failed, a stop signal.
[[nodiscard]] Result<Performed> perform(const Scenario& scenario, const Recording& recording,
                                        const PerformOptions& options);

}  // namespace liloc::faults
