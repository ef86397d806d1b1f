#pragma once
#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "client/session/codec_choice.hpp"
#include "client/session/open_requests.hpp"
#include "client/session/server_choice.hpp"
#include "client/session/session_clock.hpp"
#include "client/session/session_report.hpp"
#include "common/base/bounded_queue.hpp"

namespace liloc {

/// A session's conversation with the servers: requests leave on a thread of its own, replies count where this
/// session asked for them and their server is the one that is followed. Thread-safe; who hears a line of the
/// log may ask.
class ServerTalk {
 public:
  using Time = std::chrono::steady_clock::time_point;
  /// Sends a request; on the sending thread, may wait. An error counts as unsent; none at all as well.
  using Send = std::function<Status(const SpotRequest&)>;

  /// Clouds travel as `wanted` where the servers in sight read it. `clock` and `report` outlive it.
  ServerTalk(std::string client_id, CloudCodec wanted, Send send, SessionClock& clock, SessionReport& report);
  ~ServerTalk() = default;
  ServerTalk(const ServerTalk&) = delete;
  ServerTalk& operator=(const ServerTalk&) = delete;

  /// Queues; the oldest that waits makes room, and counts as unsent.
  void ask(SpotRequest request);
  /// Sends what waits, and from then on nothing. Idempotent.
  void close();
  /// As what the clouds of the next request are to travel (CodecChoice).
  [[nodiscard]] CloudCodec choose_codec(Time now = std::chrono::steady_clock::now());

  /// What a server says it reads.
  void heard_server(const std::string& server_id, const std::vector<CloudCodec>& reads,
                    Time now = std::chrono::steady_clock::now());
  /// False where another server's answers count (ServerChoice), and for a reply that nobody asked for.
  [[nodiscard]] bool takes(const SpotReply& reply, Time now = std::chrono::steady_clock::now());
  /// To be asked often: another server's reply that counts by now. Once.
  [[nodiscard]] std::optional<SpotReply> take_overdue(Time now = std::chrono::steady_clock::now());
  /// Requests have been unanswered for a while, whichever server is asked.
  [[nodiscard]] bool unanswered(Time now = std::chrono::steady_clock::now()) const;

  /// Another device was seen to ask under this id: a problem for ten seconds.
  void namesake_heard(Time now = std::chrono::steady_clock::now());
  /// For people; empty: nothing was noticed.
  [[nodiscard]] std::string problem(Time now = std::chrono::steady_clock::now()) const;

 private:
  void send(SpotRequest request);
  void tell_change(const std::string& before, const std::string& followed);
  [[nodiscard]] std::string namesake_problem() const;

  const std::string client_id_;
  const Send send_;
  SessionClock& clock_;
  SessionReport& report_;

  mutable std::mutex mutex_;  ///< guards what follows, down to namesake_at_
  ServerChoice servers_;
  CodecChoice codecs_;
  CloudCodec codec_;  ///< of the newest requests
  OpenRequests open_;
  std::optional<Time> unanswered_since_;  ///< the first request since the last reply left
  std::optional<Time> namesake_at_;

  LineLimit codec_lines_;   ///< of the thread that asks
  LineLimit server_lines_;  ///< of the thread that hears replies
  BoundedQueue<SpotRequest> outbox_;
  std::jthread sending_;  ///< last: it ends before what it uses
};

}  // namespace liloc
