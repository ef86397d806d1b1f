#pragma once
// What the service remembers of each run of a client: how often it asks, and what it was last answered.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
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
        clients_.try_emplace(from.client_id, Client{from.publication, from.session, {}, {}});
    if (is_new || is_current(from)) return false;
    client->second.publication = from.publication;
    client->second.session = from.session;
    client->second.status.reset();
    return true;
  }
  /// True where a run that was not the last one of its client goes on: two devices have one id. To be asked
  /// before `begins`; at most once in ten seconds for a client, so that it can be told each time.
  [[nodiscard]] bool has_twin(const wire::Sender& from, std::chrono::steady_clock::time_point now) {
    const auto run = runs_.find(from.publication);
    const auto client = clients_.find(from.client_id);
    if (run == runs_.end() || run->second.session != from.session || client == clients_.end()) return false;
    if (is_current(from) || now < client->second.quiet_until) return false;
    client->second.quiet_until = now + std::chrono::seconds(10);
    return true;
  }
  /// False once the client has left, or begun anew.
  [[nodiscard]] bool is_current(const wire::Sender& from) const {
    const auto client = clients_.find(from.client_id);
    return client != clients_.end() && client->second.publication == from.publication &&
           client->second.session == from.session;
  }
  /// By its own writer's requests alone: another's say nothing, whatever id they carry.
  [[nodiscard]] bool is_late(const wire::Sender& from, std::uint64_t seq) const {
    const auto run = runs_.find(from.publication);
    return run != runs_.end() && run->second.session == from.session && seq <= run->second.last_answered;
  }
  void answered(const wire::Sender& from, std::uint64_t seq, SpotStatus status) {
    if (is_current(from)) clients_.at(from.client_id).status = status;
    if (!rates_.contains(from.publication)) return;  // it is gone
    const auto [run, is_new] = runs_.try_emplace(from.publication, Run{from.session, seq});
    if (is_new) return;
    const bool same = run->second.session == from.session;
    run->second = {from.session, same ? std::max(run->second.last_answered, seq) : seq};
  }
  /// Clients whose last answer was so.
  [[nodiscard]] std::uint32_t clients(SpotStatus status) const {
    return static_cast<std::uint32_t>(
        std::ranges::count_if(clients_, [status](const auto& entry) { return entry.second.status == status; }));
  }
  void forget_publication(std::uint64_t publication) {
    rates_.erase(publication);
    runs_.erase(publication);
  }
  void forget_client(const std::string& client_id) { clients_.erase(client_id); }

 private:
  struct Client {
    std::uint64_t publication = 0, session = 0;  ///< of the run that was heard last
    std::chrono::steady_clock::time_point quiet_until;
    std::optional<SpotStatus> status;  ///< of the last answer
  };
  struct Run {
    std::uint64_t session = 0, last_answered = 0;
  };
  double max_rate_hz_;
  std::map<std::uint64_t, RateLimit> rates_;
  std::map<std::uint64_t, Run> runs_;  ///< by publication, once answered
  std::map<std::string, Client> clients_;
};

}  // namespace liloc
