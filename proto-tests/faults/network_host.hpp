#pragma once
// A host of a network of our own: a network namespace with a loopback and one interface whose other end is a
// descriptor here.
#include <array>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "common/base/result.hpp"

namespace liloc::faults {

using Mac = std::array<std::uint8_t, 6>;

inline constexpr char kInterface[] = "lan0";  ///< of every host

/// Whether the system lets this program have networks and mounts that nobody else sees: asked in a process of
/// its own, by the system's calls alone. Error: it does not; the remedy is in the text. What fails where this
/// says yes is broken, and no reason to leave a test out.
[[nodiscard]] Status permitted();

/// To be called before the program's first thread: from now on it may make networks and mounts that nobody else
/// sees, also where it does not run as root. Error: the system does not permit it; the remedy is in the text.
[[nodiscard]] Status enter_own_namespaces();

/// Thread-safe. Goes with what runs in it, but for processes, which their owner ends first.
class NetworkHost {
 public:
  /// `address`: IPv4, of a /24. Errors: the system does not permit network namespaces or TAP devices.
  [[nodiscard]] static Result<std::unique_ptr<NetworkHost>> create(const std::string& name,
                                                                   const std::string& address);
  ~NetworkHost();
  NetworkHost(const NetworkHost&) = delete;
  NetworkHost& operator=(const NetworkHost&) = delete;

  /// Runs `work` on the host's own thread, and waits for it: the sockets that it opens and the processes that
  /// it starts are the host's. Not from inside `work`.
  void within(const std::function<void()>& work);
  /// As a device has it that roams to another network: the address before is gone.
  [[nodiscard]] Status change_address(const std::string& address);

  [[nodiscard]] const std::string& name() const { return name_; }
  /// Frames of Ethernet, to and from the interface; not blocking.
  [[nodiscard]] int wire() const { return wire_; }
  [[nodiscard]] const Mac& mac() const { return mac_; }

 private:
  explicit NetworkHost(std::string name) : name_(std::move(name)) {}
  void serve(const std::stop_token& stop);
  [[nodiscard]] Status open(const std::string& address);

  const std::string name_;
  int wire_ = -1;
  Mac mac_{};
  std::mutex mutex_;
  std::condition_variable_any changed_;
  const std::function<void()>* work_ = nullptr;  ///< in hand; null: none
  std::jthread thread_;                          // last: it ends before what it uses
};

}  // namespace liloc::faults
