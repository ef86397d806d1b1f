#pragma once
// Between the public API's plain structs and the domain's types. The options are checked here.
#include "client/include/liloc/client.hpp"
#include "client/session/session.hpp"

namespace liloc::client {

/// Errors name the option, its value and its range.
[[nodiscard]] Result<SessionOptions> to_session(const Options& options);
/// Error: not a pose; `what` names it.
[[nodiscard]] Result<liloc::Pose> to_domain(const Pose& T, std::string_view what);
[[nodiscard]] PoseUpdate to_public(const FrameResult& frame, Tracking tracking, bool connected);
[[nodiscard]] Reply to_public(const SpotReply& reply);
[[nodiscard]] Stats to_public(const SessionStats& stats);

}  // namespace liloc::client
