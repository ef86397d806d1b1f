#pragma once
// The sensors of a run: ceiling LiDARs that come and go, and the cameras of the residents.
#include <cstdint>

#include "common/wire/dds/participant.hpp"
#include "proto-tests/soak/tape.hpp"

namespace liloc::soak {

/// The device that a resident or a visitor is, by its number: its way on the tape under a name of its own.
[[nodiscard]] DeviceInfo resident_of(const Tape& tape, std::size_t number);

/// Streams until the run is over or a stop signal came; in a process of its own. Returns how often a LiDAR
/// went. Errors: DDS.
[[nodiscard]] Result<std::uint64_t> play_stage(const Tape& tape, const SoakOptions& options,
                                               const RunClock& clock, const wire::DomainOptions& seat);

}  // namespace liloc::soak
