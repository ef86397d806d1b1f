#pragma once
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/wire/dds/address_watch.hpp"
#include "common/wire/spots/client_link.hpp"
#include "common/wire/spots/status.hpp"

namespace liloc::client {

/// A client's seat on the network. Where the address of its interface is replaced, as when a device roams, it
/// takes a new one by itself: DDS tells others the address of its start for ever. Other participants of the
/// process in that domain keep it from doing so.
class Network {
 public:
  /// All run on the network's thread, one at a time.
  struct Callbacks {
    wire::ClientCallbacks link;
    std::function<void(const wire::ServerStatus&)> on_status;
    std::vector<std::pair<std::chrono::milliseconds, std::function<void()>>> tasks;  ///< and how often
  };

  /// Errors: an option, DDS.
  [[nodiscard]] static Result<std::unique_ptr<Network>> join(wire::DomainOptions seat, std::string client_id,
                                                             Callbacks callbacks);
  ~Network();
  Network(const Network&) = delete;
  Network& operator=(const Network&) = delete;

  /// From here on callbacks run.
  void start();
  /// None runs after this returned. Safe to call twice; not from a callback.
  void stop();
  /// As ClientLink has it. Any thread.
  [[nodiscard]] Status send(const SpotRequest& request);
  /// As ClientLink has it. From a callback alone.
  void announce();

 private:
  Network(wire::DomainOptions seat, std::string client_id, Callbacks callbacks);
  [[nodiscard]] Status open();
  void leave();
  void rejoin();
  void keep(const std::stop_token& stop);

  const wire::DomainOptions seat_;
  const std::string client_id_;
  const Callbacks callbacks_;
  wire::AddressWatch addresses_;
  bool away_ = false;  ///< it could not join again yet; of the keeper, as is the watch
  std::mutex mutex_;   ///< held to send, and to leave; guards what follows, down to the link
  std::optional<wire::Participant> participant_;
  std::unique_ptr<wire::Dispatcher> dispatcher_;
  std::unique_ptr<wire::ClientLink> link_;
  std::uint64_t session_ = 0;  ///< 0 before the first link
  std::jthread keeper_;        // last: it ends before what it uses
};

}  // namespace liloc::client
