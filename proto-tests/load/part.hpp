#pragma once
// The devices of one process, played in real time.
#include "proto-tests/load/device.hpp"

namespace liloc::load {

/// Returns when all have left and the last replies came, or a stop signal did. Errors: DDS.
[[nodiscard]] Result<Outcomes> play_part(const Script& script, const LoadOptions& options,
                                         const RunClock& clock, const std::vector<DevicePlan>& plans,
                                         const wire::DomainOptions& seat);

}  // namespace liloc::load
