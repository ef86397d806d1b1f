#pragma once
// What the service remembers of each run of a client: how often it asks, and what it was last answered.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <string>

#include "common/wire/server_link.hpp"

namespace liloc {

/// Lets `rate_hz` a second through, and up to a second's worth at once.
class RateLimit {
 public:
  explicit RateLimit(double rate_hz) : rate_hz_(rate_hz), tokens_(std::max(rate_hz, 1.0)) {}
  [[nodiscard]] bool admit(std::chrono::steady_clock::time_point now) {
    const double elapsed_s = std::chrono::duration<double>(now - last_).count();
    tokens_ = std::min(std::max(rate_hz_, 1.0), tokens_ + std::max(elapsed_s, 0.0) * rate_hz_);
    last_ = now;
    if (tokens_ < 1) return false;
    tokens_ -= 1;
    return true;
  }

 private:
  double rate_hz_, tokens_;
  std::chrono::steady_clock::time_point last_;
};

/// Not thread-safe: its owner locks. Bounded by the publications that DDS knows and the clients it serves.
class Sessions {
 public:
  explicit Sessions(double max_rate_hz) : max_rate_hz_(max_rate_hz) {}

  [[nodiscard]] bool admit(const wire::Arrival& arrival) {
    return rates_.try_emplace(arrival.from.publication, max_rate_hz_).first->second.admit(arrival.at);
  }
  /// True if this is not the run of the client that was heard last: what is known of it holds no longer.
  [[nodiscard]] bool begins(const wire::Sender& from) {
    auto [client, is_new] =
        clients_.try_emplace(from.client_id, Client{from.session, false, 0, SpotStatus::refused});
    if (is_new || client->second.session == from.session) return false;
    client->second = {from.session, false, 0, SpotStatus::refused};
    return true;
  }
  /// False once the client has left, or begun anew.
  [[nodiscard]] bool is_current(const wire::Sender& from) const {
    const auto client = clients_.find(from.client_id);
    return client != clients_.end() && client->second.session == from.session;
  }
  [[nodiscard]] bool is_late(const wire::Sender& from, std::uint64_t seq) const {
    return is_current(from) && clients_.at(from.client_id).answered &&
           seq <= clients_.at(from.client_id).last_answered;
  }
  void answered(const wire::Sender& from, std::uint64_t seq, SpotStatus status) {
    if (!is_current(from)) return;
    Client& client = clients_.at(from.client_id);
    client.last_answered = client.answered ? std::max(client.last_answered, seq) : seq;
    client.answered = true;
    client.status = status;
  }
  /// Clients whose last answer was so.
  [[nodiscard]] std::uint32_t clients(SpotStatus status) const {
    return static_cast<std::uint32_t>(std::ranges::count_if(clients_, [status](const auto& entry) {
      return entry.second.answered && entry.second.status == status;
    }));
  }
  void forget_publication(std::uint64_t publication) { rates_.erase(publication); }
  void forget_client(const std::string& client_id) { clients_.erase(client_id); }

 private:
  struct Client {
    std::uint64_t session = 0;
    bool answered = false;
    std::uint64_t last_answered = 0;
    SpotStatus status = SpotStatus::refused;  ///< of the last answer
  };
  double max_rate_hz_;
  std::map<std::uint64_t, RateLimit> rates_;
  std::map<std::string, Client> clients_;
};

}  // namespace liloc
