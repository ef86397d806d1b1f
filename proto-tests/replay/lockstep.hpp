#pragma once
#include "common/recording/recording.hpp"
#include "proto-tests/replay/options.hpp"
#include "proto-tests/replay/report.hpp"

namespace liloc::replay {

/// Runs server and clients in this process, without DDS and as fast as they can, in the order of the stamps:
/// the same recording, options and seed give the same answers. As in the server, a request is answered once
/// every LiDAR has delivered a frame that counts for it, or after 100 ms of recorded time; later frames profit,
/// earlier ones do not. Writes the traces into OUT, which must be prepared. Errors: the traces cannot be
/// written, the weights cannot be read any more, or a stop signal.
[[nodiscard]] Result<RunFacts> run_lockstep(const Recording& recording, const ReplayOptions& options,
                                            const Progress& progress);

}  // namespace liloc::replay
