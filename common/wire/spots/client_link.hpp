#pragma once
// A device's side of the conversation with the server.
//
//   auto link = wire::ClientLink::create(dispatcher, "robot1", {.on_reply = [](SpotReply reply) { ... }});
//   dispatcher.start();
//   if ((*link)->server_matched()) (*link)->send(request);
#include <functional>
#include <memory>
#include <string>

#include "common/protocol/spot.hpp"
#include "common/wire/dds/dispatcher.hpp"

namespace liloc::wire {

/// Run on the dispatcher's thread; any may be empty.
struct ClientCallbacks {
  std::function<void(SpotReply)> on_reply = {};        ///< to a request of this run of the client
  std::function<void(bool matched)> on_server = {};    ///< the server came or went
  std::function<void()> on_server_found = {};          ///< one more: the first, another, or one that began anew
  std::function<void(std::string)> on_bad_reply = {};  ///< a reply that was dropped, and why
  std::function<void()> on_namesake = {};  ///< another device asks under this id; at each answer to it
};

class ClientLink {
 public:
  /// Before the dispatcher starts; the dispatcher must outlive the link's last `send`. Error: not a valid id.
  /// `session`: of an earlier link of this run of the client, so that the server takes both for one; 0: drawn.
  [[nodiscard]] static Result<std::unique_ptr<ClientLink>> create(Dispatcher& dispatcher,
                                                                  const std::string& client_id,
                                                                  ClientCallbacks callbacks,
                                                                  std::uint64_t session = 0);
  ~ClientLink();
  ClientLink(const ClientLink&) = delete;
  ClientLink& operator=(const ClientLink&) = delete;

  /// Never waits long (20 ms at most). `request.client_id` must be the link's. With no server matched the
  /// request goes nowhere, and that is an error; so is a request that cannot travel (over 256 poses, 256 KiB of
  /// cloud). Any thread.
  [[nodiscard]] Status send(const SpotRequest& request);
  [[nodiscard]] std::uint64_t session() const;
  /// Tells the servers' hosts that this client is here, ahead of the time when it would tell them anyway: a
  /// server that was started anew finds its clients by that. Any thread.
  void announce();
  /// Both directions are matched, so that nothing sent now is lost for want of discovery. Any thread.
  [[nodiscard]] bool server_matched() const;

 private:
  struct Impl;
  explicit ClientLink(std::shared_ptr<Impl> impl);
  std::shared_ptr<Impl> impl_;
};

}  // namespace liloc::wire
