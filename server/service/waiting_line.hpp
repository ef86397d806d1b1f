#pragma once
// The requests that wait for a worker. Not thread-safe: its owner locks.
#include <algorithm>
#include <deque>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "common/wire/server_link.hpp"

namespace liloc {

/// Bounded, oldest first, except that a client has at most one request in work: the answers of one client build
/// on each other, and a second worker would only wait for the first.
class WaitingLine {
 public:
  explicit WaitingLine(std::size_t capacity) : capacity_(capacity) {}

  /// Returns the oldest request where there was no room for one more.
  [[nodiscard]] std::optional<wire::Arrival> push(wire::Arrival arrival) {
    std::optional<wire::Arrival> displaced;
    if (waiting_.size() >= capacity_) displaced = taken(waiting_.begin());
    waiting_.push_back(std::move(arrival));
    return displaced;
  }
  /// The waiting request of a client, taken out.
  [[nodiscard]] std::optional<wire::Arrival> take(const std::string& client_id) {
    return taken(std::ranges::find_if(waiting_, [&](const auto& w) { return w.from.client_id == client_id; }));
  }
  /// The oldest request whose client has none in work; its client has from now on.
  [[nodiscard]] std::optional<wire::Arrival> begin() {
    auto next = taken(
        std::ranges::find_if(waiting_, [&](const auto& w) { return !in_work_.contains(w.from.client_id); }));
    if (next) in_work_.insert(next->from.client_id);
    return next;
  }
  void end(const std::string& client_id) { in_work_.erase(client_id); }

  [[nodiscard]] std::size_t size() const { return waiting_.size(); }
  [[nodiscard]] bool empty() const { return waiting_.empty(); }

 private:
  std::optional<wire::Arrival> taken(std::deque<wire::Arrival>::iterator at) {
    if (at == waiting_.end()) return std::nullopt;
    std::optional<wire::Arrival> arrival(std::move(*at));
    waiting_.erase(at);
    return arrival;
  }

  const std::size_t capacity_;
  std::deque<wire::Arrival> waiting_;
  std::set<std::string> in_work_;
};

}  // namespace liloc
