#pragma once
// Clients of the library that come, are located and go, one process of them.
#include <type_traits>

#include "common/wire/dds/participant.hpp"
#include "proto-tests/soak/schedule.hpp"
#include "proto-tests/soak/tape.hpp"

namespace liloc::soak {

/// One stay. Plain bytes: it goes from process to process.
struct Visit {
  double from_s = 0, to_s = 0;
  double located_after_s = -1;  ///< until the first verified answer; under 0: none came
  std::uint64_t frames = 0, requests = 0, replies = 0, verified = 0;
  [[nodiscard]] bool located() const { return located_after_s >= 0; }
};
static_assert(std::is_trivially_copyable_v<Visit>);

/// Plays all visits, each under a name of its own, until the run is over or a stop signal came; in a process of
/// its own. Errors: a client cannot be made.
[[nodiscard]] Result<std::vector<Visit>> play_visitors(const Tape& tape, const SoakOptions& options,
                                                       const RunClock& clock, const wire::DomainOptions& seat);

}  // namespace liloc::soak
