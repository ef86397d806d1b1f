#pragma once
// What the service remembers of each client: how often it asks, and what it was last answered.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "server/service/request_queue.hpp"

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

  /// By identity: however many writers share one, they share its rate.
  [[nodiscard]] bool admit(const wire::Arrival& arrival) {
    return rates_.try_emplace(arrival.from.client_id, max_rate_hz_).first->second.admit(arrival.at);
  }
  /// True if this is not the run of the client that was heard last: what is known of it holds no longer.
  [[nodiscard]] bool begins(const wire::Sender& from) {
    Run& run = runs_[from.publication];
    if (run.session != from.session) run = {from.session, {}};
    auto [client, is_new] = clients_.try_emplace(from.client_id);
    if (is_new) client->second.served = std::chrono::steady_clock::now();
    const bool anew = !is_new && !is_current(from);
    client->second.publication = from.publication;
    client->second.session = from.session;
    if (!anew) return false;
    client->second.status.reset();
    client->second.tracked_segment.reset();
    return true;
  }
  /// True where a run that was not the last one of its client goes on: two devices have one id. To be asked
  /// before `begins`.
  [[nodiscard]] bool has_twin(const wire::Sender& from) const {
    const Run* run = run_of(from);
    return run != nullptr && run->last_answered && clients_.contains(from.client_id) && !is_current(from);
  }
  /// False once the client has left, or begun anew.
  [[nodiscard]] bool is_current(const wire::Sender& from) const {
    const auto client = clients_.find(from.client_id);
    return client != clients_.end() && client->second.publication == from.publication &&
           client->second.session == from.session;
  }
  /// Whether the run of the sender is the client's last one, by whichever of its writers.
  [[nodiscard]] bool goes_on(const wire::Sender& from) const {
    const auto client = clients_.find(from.client_id);
    return client != clients_.end() && client->second.session == from.session;
  }
  /// By its own writer's requests alone: another's say nothing, whatever id they carry.
  [[nodiscard]] bool is_late(const wire::Sender& from, std::uint64_t seq) const {
    const Run* run = run_of(from);
    return run != nullptr && run->last_answered && seq <= *run->last_answered;
  }
  void answered(const wire::Arrival& arrival, const SpotReply& reply) {
    if (Run* run = run_of(arrival.from))
      run->last_answered = std::max(run->last_answered.value_or(0), arrival.request.seq);
    if (!is_current(arrival.from)) return;
    Client& client = clients_.at(arrival.from.client_id);
    client.status = reply.status;
    client.served = std::chrono::steady_clock::now();
    client.tracked_segment.reset();
    if (!reply.verified()) return;
    client.known = true;
    if (!arrival.request.cold) client.tracked_segment = arrival.request.odom_segment;
  }
  /// Clients whose last answer was so.
  [[nodiscard]] std::uint32_t clients(SpotStatus status) const {
    return static_cast<std::uint32_t>(
        std::ranges::count_if(clients_, [status](const auto& entry) { return entry.second.status == status; }));
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
  void forget_publication(std::uint64_t publication) { runs_.erase(publication); }
  void forget_client(const std::string& client_id) {
    clients_.erase(client_id);
    rates_.erase(client_id);
  }

 private:
  struct Client {
    std::uint64_t publication = 0, session = 0;    ///< of the run that was heard last
    std::optional<SpotStatus> status;              ///< of the last answer
    bool known = false;                            ///< verified once, by whichever run
    std::optional<std::uint32_t> tracked_segment;  ///< of odometry, whose last answer was verified
    std::chrono::steady_clock::time_point served{};
  };
  struct Run {
    std::uint64_t session = 0;
    std::optional<std::uint64_t> last_answered;
  };
  /// Null where it never began, or its writer is gone.
  [[nodiscard]] const Run* run_of(const wire::Sender& from) const {
    const auto run = runs_.find(from.publication);
    return run != runs_.end() && run->second.session == from.session ? &run->second : nullptr;
  }
  [[nodiscard]] Run* run_of(const wire::Sender& from) {
    return const_cast<Run*>(std::as_const(*this).run_of(from));
  }

  double max_rate_hz_;
  std::map<std::string, RateLimit> rates_;
  std::map<std::uint64_t, Run> runs_;  ///< by publication
  std::map<std::string, Client> clients_;
};

}  // namespace liloc
