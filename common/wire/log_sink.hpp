#pragma once
// Private to the room: where Cyclone's own lines go.

namespace liloc::wire {

/// Sends Cyclone's warnings and errors to liloc::log, at most ten a second: it writes one for each bad sample
/// that a stranger sends. Idempotent; before the first domain.
void install_log_sink();

}  // namespace liloc::wire
