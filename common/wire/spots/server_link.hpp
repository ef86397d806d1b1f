#pragma once
// The server's side: requests of all clients in, each bound to who really sent it, and replies out.
//
// A client reads and writes in partition robots/<id>. The partition of the writer that DDS names for a sample
// is the identity; the id in the payload is only compared with it.
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "common/protocol/spot.hpp"
#include "common/wire/dds/dispatcher.hpp"

namespace liloc::wire {

/// Who a request came from. `publication` differs between two runs of one client; so does `session`.
struct Sender {
  std::string client_id;  ///< bound by DDS, not claimed
  std::uint64_t publication = 0;
  std::uint64_t session = 0;
};

/// `problem` is Reason::none for a request that may be worked on; otherwise identity, protocol_version or
/// bad_request, `text` says why, and of `request` only client_id (the sender's), seq, stamp and segment are
/// set.
struct Arrival {
  Sender from;
  SpotRequest request;
  Reason problem = Reason::none;
  std::string text;
  std::chrono::steady_clock::time_point at;
};

/// Run on the dispatcher's thread.
struct ServerCallbacks {
  std::function<void(Arrival)> on_request = {};
  std::function<void(const std::string& client_id)> on_join = {};   ///< its first writer was seen
  std::function<void(const std::string& client_id)> on_leave = {};  ///< its last writer is gone
  std::function<void(std::uint64_t publication)> on_gone =
      {};  ///< this writer is gone; its handle may be forgotten
};

/// Defaults are by hand where nothing else is said.
struct ServerLinkOptions {
  std::string server_id = "liloc";
  std::size_t max_clients = 512;  ///< more are not served; a warning says so
};

class ServerLink {
 public:
  /// Before the dispatcher starts.
  [[nodiscard]] static Result<std::unique_ptr<ServerLink>> create(Dispatcher& dispatcher,
                                                                  ServerLinkOptions options,
                                                                  ServerCallbacks callbacks);
  ~ServerLink();
  ServerLink(const ServerLink&) = delete;
  ServerLink& operator=(const ServerLink&) = delete;

  /// Sends `reply`, as server_id's, to the sender's partition and session. Never waits long. Any thread.
  /// Error: the client has left.
  [[nodiscard]] Status reply(const Sender& to, SpotReply reply);
  [[nodiscard]] std::size_t clients() const;

 private:
  struct Impl;
  explicit ServerLink(std::shared_ptr<Impl> impl);
  std::shared_ptr<Impl> impl_;
};

}  // namespace liloc::wire
