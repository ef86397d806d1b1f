#pragma once
// The requests that wait for a worker, and whose turn it is. Not thread-safe: its owner locks.
#include <algorithm>
#include <chrono>
#include <deque>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "common/wire/spots/server_link.hpp"

namespace liloc {

/// What is known of who asks, by rising claim to an answer. A tracked device's answer takes a tenth of the work
/// that a search of the whole room takes, and it is worth most while it is fresh.
enum class Standing {
  stranger,  ///< never verified
  known,     ///< verified before, and has lost its way since
  tracked,   ///< its last answer was verified, and its odometry has held since
};

struct Waiting {
  wire::Arrival arrival;
  Standing standing = Standing::stranger;
  std::chrono::steady_clock::time_point served;  ///< when its client was last worked for, or first asked

  [[nodiscard]] bool searches() const { return standing != Standing::tracked; }
};

/// Bounded. Tracked devices first, but searches get at least a quarter of the work, and all of it that nobody
/// else wants. Within each kind the one that was served longest ago comes first, which is the earliest
/// deadline: all poses age alike. A client has at most one request in work: its answers build on each other,
/// and a second worker would only wait for the first.
class RequestQueue {
 public:
  using Duration = std::chrono::steady_clock::duration;
  static constexpr double kSearchShare = 0.25;
  /// Strangers wait so much longer than known devices that search.
  static constexpr Duration kStrangerWait = std::chrono::seconds(2);
  /// Most work that searches are owed, or have had before their time, so that an idle hour does not become a
  /// busy minute.
  static constexpr Duration kMostOwed = std::chrono::milliseconds(200);
  /// About what one takes: owed less, a search waits.
  static constexpr Duration kSearch = std::chrono::milliseconds(40);

  explicit RequestQueue(std::size_t capacity) : capacity_(capacity) {}

  /// Where there was no room for one more it returns the one with the least claim, of those the oldest.
  [[nodiscard]] std::optional<wire::Arrival> push(Waiting waiting) {
    waiting_.push_back(std::move(waiting));
    if (waiting_.size() <= capacity_) return std::nullopt;
    return arrival_of(taken(std::ranges::min_element(waiting_, {}, &Waiting::standing)));
  }
  /// The waiting request of a client, taken out.
  [[nodiscard]] std::optional<wire::Arrival> take(const std::string& client_id) {
    return arrival_of(taken(
        std::ranges::find(waiting_, client_id, [](const Waiting& w) { return w.arrival.from.client_id; })));
  }
  /// The request whose turn it is of those whose client has none in work; its client has from now on.
  [[nodiscard]] std::optional<Waiting> begin() {
    const auto tracked = next(false), search = next(true);
    const bool searching = search != waiting_.end() && (tracked == waiting_.end() || owed_ >= kSearch);
    auto begun = taken(searching ? search : tracked);
    if (!begun) return begun;
    in_work_.insert(begun->arrival.from.client_id);
    if (begun->searches()) owed_ -= kSearch;  // at once: other workers ask before it ends
    return begun;
  }
  /// Its work took so long.
  void end(const Waiting& done, Duration took) {
    in_work_.erase(done.arrival.from.client_id);
    const auto earned = std::chrono::duration_cast<Duration>(took * (kSearchShare / (1 - kSearchShare)));
    owed_ = std::clamp(done.searches() ? owed_ + kSearch - took : owed_ + earned, -kMostOwed, kMostOwed);
  }

  [[nodiscard]] std::size_t size() const { return waiting_.size(); }
  [[nodiscard]] bool empty() const { return waiting_.empty(); }

 private:
  using Place = std::deque<Waiting>::iterator;

  [[nodiscard]] Place next(bool searches) {
    const auto key = [](const Waiting& w) {
      return w.standing == Standing::stranger ? w.served + kStrangerWait : w.served;
    };
    Place first = waiting_.end();
    for (Place at = waiting_.begin(); at != waiting_.end(); ++at)
      if (at->searches() == searches && !in_work_.contains(at->arrival.from.client_id) &&
          (first == waiting_.end() || key(*at) < key(*first)))
        first = at;
    return first;
  }
  std::optional<Waiting> taken(Place at) {
    if (at == waiting_.end()) return std::nullopt;
    std::optional<Waiting> waiting(std::move(*at));
    waiting_.erase(at);
    return waiting;
  }
  static std::optional<wire::Arrival> arrival_of(std::optional<Waiting> waiting) {
    if (!waiting) return std::nullopt;
    return std::move(waiting->arrival);
  }

  const std::size_t capacity_;
  std::deque<Waiting> waiting_;  ///< in the order in which they came
  std::set<std::string> in_work_;
  Duration owed_{};  ///< work to searches, for the work that tracked devices got
};

}  // namespace liloc
