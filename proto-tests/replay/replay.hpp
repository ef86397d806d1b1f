#pragma once
#include "proto-tests/replay/options.hpp"
#include "proto-tests/replay/report.hpp"

namespace liloc::replay {

/// What ended a replay early, and whether the caller's input was at fault (exit code 2) or the run (1).
struct ReplayError {
  Error error;
  bool bad_input = false;
};

/// Replays a recording and writes OUT: traces per device and report.json. Until the recording, the options and
/// the folder have been found good, nothing is created.
[[nodiscard]] tl::expected<Report, ReplayError> replay(const ReplayOptions& options,
                                                       const Progress& progress = {});

}  // namespace liloc::replay
