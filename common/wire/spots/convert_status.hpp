#pragma once
// Private to the room: a server's status, to the wire and, checked, from it.
#include <liloc.h>

#include <vector>

#include "common/wire/spots/status.hpp"

namespace liloc::wire {

struct StatusSample {
  liloc_msg_ServerStatus message{};
  std::vector<liloc_msg_LidarHealth> lidars;
  std::vector<std::uint8_t> codecs;
};
/// Lends nothing of `status`; of the LiDARs the first 64 go.
[[nodiscard]] StatusSample to_wire(const ServerStatus& status);
[[nodiscard]] Result<ServerStatus> from_wire(const liloc_msg_ServerStatus& message);

}  // namespace liloc::wire
