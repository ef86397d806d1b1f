#pragma once
// Puts on the board what has changed. Not thread-safe: the page's thread owns it.
#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "server/view/board.hpp"
#include "server/view/source.hpp"

namespace liloc::view {

class Painter {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// `board` outlives this.
  Painter(Source source, Board& board) : source_(std::move(source)), board_(board) {}

  /// What has changed since the last time. The room is told every two seconds at most, trails every five,
  /// charts every one: they change slowly and are large.
  void paint(Time now);
  /// Nobody looks: keeps nothing.
  void rest();
  /// The cloud of a device that was not located, as a points message; null where there is none, or no place to
  /// draw it. Drawn once for all who ask.
  [[nodiscard]] std::shared_ptr<const std::string> scan_of(const std::string& client_id);

 private:
  void paint_points(Time now);

  const Source source_;
  Board& board_;
  struct Shown {
    std::shared_ptr<const Snapshot> moment;
    std::shared_ptr<const StitchedRoom> room;
    std::optional<Time> site_at, room_at, trails_at, charts_at;
    std::optional<std::uint64_t> log_count;
  };
  Shown shown_;
  struct Drawn {
    std::weak_ptr<const UnlocatedScan> of;
    std::shared_ptr<const std::string> message;  ///< null: it cannot be drawn
  };
  std::deque<Drawn> scans_;  ///< drawn lately
};

}  // namespace liloc::view
