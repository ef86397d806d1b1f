#pragma once
// What the service remembers of each client: how often it asks, and what it was last answered.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "server/service/waiting_line.hpp"

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

/// Not thread-safe: its owner locks. Bounded by the clients that are served.
class Sessions {
 public:
  explicit Sessions(double max_rate_hz) : max_rate_hz_(max_rate_hz) {}

  /// By identity: however many writers share one, they share its rate.
  [[nodiscard]] bool admit(const wire::Arrival& arrival) {
    return rates_.try_emplace(arrival.from.client_id, max_rate_hz_).first->second.admit(arrival.at);
  }
  /// True if this is not the run of the client that was heard last: what is known of it holds no longer.
  [[nodiscard]] bool begins(const wire::Sender& from) {
    auto [client, is_new] = clients_.try_emplace(from.client_id);
    const bool anew = !is_new && client->second.session != from.session;
    if (is_new || anew) {
      client->second.session = from.session;
      client->second.answered = false;
      client->second.tracked_segment.reset();
    }
    if (is_new) client->second.served = std::chrono::steady_clock::now();
    return anew;
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
  void answered(const wire::Arrival& arrival, const SpotReply& reply) {
    if (!is_current(arrival.from)) return;
    Client& client = clients_.at(arrival.from.client_id);
    const std::uint64_t seq = arrival.request.seq;
    client.last_answered = client.answered ? std::max(client.last_answered, seq) : seq;
    client.answered = true;
    client.served = std::chrono::steady_clock::now();
    client.tracked_segment.reset();
    if (!reply.verified()) return;
    client.known = true;
    if (!arrival.request.cold) client.tracked_segment = arrival.request.odom_segment;
  }
  /// The request with its claim to an answer.
  [[nodiscard]] Waiting waiting(wire::Arrival arrival) const {
    const auto found = clients_.find(arrival.from.client_id);
    if (found == clients_.end()) {
      const auto at = arrival.at;
      return {std::move(arrival), Standing::stranger, at};
    }
    const Client& client = found->second;
    const bool tracked = client.tracked_segment == arrival.request.odom_segment && !arrival.request.cold;
    return {std::move(arrival),
            tracked        ? Standing::tracked
            : client.known ? Standing::known
                           : Standing::stranger,
            client.served};
  }
  void forget_client(const std::string& client_id) {
    clients_.erase(client_id);
    rates_.erase(client_id);
  }

 private:
  struct Client {
    std::uint64_t session = 0;
    bool answered = false;
    std::uint64_t last_answered = 0;
    bool known = false;                            ///< verified once, by whichever run
    std::optional<std::uint32_t> tracked_segment;  ///< of odometry, whose last answer was verified
    std::chrono::steady_clock::time_point served{};
  };
  double max_rate_hz_;
  std::map<std::string, RateLimit> rates_;
  std::map<std::string, Client> clients_;
};

}  // namespace liloc
