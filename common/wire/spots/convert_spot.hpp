#pragma once
// Private to the room: requests and replies, to the wire and, checked, from it.
#include <liloc.h>

#include <vector>

#include "common/protocol/spot.hpp"

namespace liloc::wire {

/// A sample that lends the request's memory: valid while the request lives.
struct RequestSample {
  liloc_msg_SpotRequest message{};
  std::vector<liloc_msg_LocalPose> poses;
};
[[nodiscard]] Result<RequestSample> to_wire(const SpotRequest& request, std::uint64_t session);
Result<RequestSample> to_wire(SpotRequest&& request,
                              std::uint64_t session) = delete;  // would lend from a temporary
[[nodiscard]] liloc_msg_SpotReply to_wire(const SpotReply& reply, std::uint64_t session);

/// The error names the field. The versions are the caller's to compare, first.
[[nodiscard]] Result<SpotRequest> from_wire(const liloc_msg_SpotRequest& message);
[[nodiscard]] Result<SpotReply> from_wire(const liloc_msg_SpotReply& message);

}  // namespace liloc::wire
