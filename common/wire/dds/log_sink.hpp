#pragma once
// Private to the room: where Cyclone's own lines go.

namespace liloc::wire {

/// Sends Cyclone's warnings and errors to liloc::log, in five seconds each text once and sixteen in all: it
/// writes one for each bad sample that a stranger sends, and four a second for each that knocks without valid
/// credentials. Idempotent; before the first domain.
void install_log_sink();

}  // namespace liloc::wire
