#pragma once
// Private to the room: the moments of a site that an answer rests on, with each image once.
#include <deque>
#include <memory>
#include <vector>

#include "server/answers/fields.hpp"

namespace liloc::answers {

// As in fields.hpp: a site has few LiDARs, and a session keeps moments for its spots alone.
constexpr std::size_t kMostLidars = 256, kMostMoments = 64;

/// Numbers the parts of some snapshots.
class RoomsOut {
 public:
  explicit RoomsOut(std::vector<const Snapshot*> snapshots) : snapshots_(std::move(snapshots)) {}
  void write(ArchiveOut& out);

 private:
  std::vector<const Snapshot*> snapshots_;
};

struct RoomsIn {
  std::shared_ptr<std::deque<GlobalLidar>> lidars = std::make_shared<std::deque<GlobalLidar>>();
  std::vector<std::shared_ptr<const Snapshot>> snapshots;
};
/// What was wrong stands in the archive's status; the snapshots are then not to be used.
[[nodiscard]] RoomsIn read_rooms(ArchiveIn& in, const SnapshotOptions& options);

}  // namespace liloc::answers
