#pragma once
#include "common/recording/recording.hpp"
#include "proto-tests/replay/options.hpp"
#include "proto-tests/replay/report.hpp"

namespace liloc::replay {

/// Starts the real server and one real client per device, streams the recording to them over DDS at the speed
/// at which it was recorded, and leaves the clients' traces in OUT, which must be prepared. All children end
/// before it returns. Errors: a program ended by itself, DDS refuses, or a stop signal came.
[[nodiscard]] Result<RunFacts> run_live(const Recording& recording, const ReplayOptions& options,
                                        const Progress& progress);

}  // namespace liloc::replay
