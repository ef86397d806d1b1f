#pragma once
#include "proto-tests/load/device.hpp"

namespace liloc::load {

/// Streams the script's ceiling frames from now on, forwards and backwards in turn, with stamps of now, until
/// `end_s` of the run or a stop signal. Returns the bytes that were sent. Errors: DDS.
[[nodiscard]] Result<std::uint64_t> stream_ceiling(const Script& script, const RunClock& clock, double end_s,
                                                   const wire::DomainOptions& seat);

}  // namespace liloc::load
