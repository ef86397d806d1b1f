#pragma once
#include <atomic>
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

/// A client's seat on the network. Where the addresses of its interface change, as when a device roams, it
/// joins anew by itself (AddressWatch). Other participants of the process in that domain keep it from doing so,
/// which is told.
class Network {
 public:
  /// All but `look` run on the network's thread, one at a time.
  struct Callbacks {
    wire::ClientCallbacks link;
    std::function<void(const wire::ServerStatus&)> on_status;
    std::vector<std::pair<std::chrono::milliseconds, std::function<void()>>> tasks;  ///< and how often
    std::function<void()> look;  ///< twice a second, also while it could not join; on a thread of its own
  };

  /// `addresses`: of the interface; empty: as the system has them. Errors: an option, DDS.
  [[nodiscard]] static Result<std::unique_ptr<Network>> join(wire::DomainOptions seat, std::string client_id,
                                                             Callbacks callbacks,
                                                             wire::AddressWatch::Addresses addresses = {});
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
  Network(wire::DomainOptions seat, std::string client_id, Callbacks callbacks,
          wire::AddressWatch::Addresses addresses);
  [[nodiscard]] Status open();
  [[nodiscard]] wire::ClientCallbacks link_callbacks();
  void leave();
  void rejoin();
  void keep(const std::stop_token& stop);

  const wire::DomainOptions seat_;
  const std::string client_id_;
  const Callbacks callbacks_;
  wire::AddressWatch addresses_;
  bool away_ = false;       ///< it could not join again yet; of the keeper, as are the watch and the next
  bool held_told_ = false;  ///< that others hold the domain
  std::atomic<bool> reached_ = false;  ///< a server is
  std::mutex mutex_;                   ///< held to send, and to leave; guards what follows, down to the link
  std::optional<wire::Participant> participant_;
  std::unique_ptr<wire::Dispatcher> dispatcher_;
  std::unique_ptr<wire::ClientLink> link_;
  std::uint64_t session_ = 0;  ///< 0 before the first link
  std::jthread keeper_;        // last: it ends before what it uses
};

}  // namespace liloc::client
