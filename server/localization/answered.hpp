#pragma once
// An answer and all that it rests on: with these the same program gives the same answer again.
#include <memory>
#include <optional>
#include <vector>

#include "server/localization/device_session.hpp"

namespace liloc {

struct Answered {
  LocalizerOptions options;
  SpotRequest request;
  std::shared_ptr<const Snapshot> room;
  std::shared_ptr<const CellBounds> bounds;
  std::optional<DeviceSession::Segment> before;  ///< what the session remembered when the request came
  std::vector<std::uint32_t> moving;             ///< of the request's points, by index
  bool spare_time = true;                        ///< for a search that nobody waits for
  SpotReply reply;                               ///< without what the service adds: server_id, latency
};

/// The request as a spot: without what moves before the device, as far as the method knows of it. A cold one
/// stands alone. The session's mutex is held.
[[nodiscard]] Result<std::shared_ptr<const Spot>> spot_of(DeviceSession& session, const SpotRequest& request,
                                                          std::shared_ptr<const Snapshot> room,
                                                          const LocalizerOptions& options,
                                                          std::shared_ptr<const CellBounds> bounds = nullptr);

/// A reply and what the search of the room rested on; no places where there was none.
struct Answer {
  SpotReply reply;
  Evidence evidence;
};
/// The session's answer to a spot, with what a person should know beside it. The session's mutex is held.
[[nodiscard]] Answer answer_of(DeviceSession& session, const std::shared_ptr<const Spot>& spot,
                               bool spare_time);

/// The answer given again, by a session that remembers what the first one did.
struct Rerun {
  std::shared_ptr<const Spot> spot;  ///< null: the request's cloud could not be used
  Answer answer;
};
/// Does not stop a search that takes long.
[[nodiscard]] Rerun run_again(const Answered& answered);

}  // namespace liloc
