#pragma once
#include <functional>
#include <set>
#include <string>

namespace liloc::wire {

/// IPv4 addresses of an interface by its name, of all but the loopback for "auto"; the address itself where one
/// is given and some interface has it. Empty where there are none now.
[[nodiscard]] std::set<std::string> addresses_of(const std::string& interface);

/// Notices that an address is gone and another has come, as when a device roams: DDS reads addresses when a
/// participant is made, tells them to all others, and never again. Not thread-safe.
class AddressWatch {
 public:
  using Addresses = std::function<std::set<std::string>()>;
  explicit AddressWatch(Addresses addresses) : addresses_(std::move(addresses)), known_(addresses_()) {}

  /// Whether one of those before is gone, once there is one again; once for each change.
  [[nodiscard]] bool changed();

 private:
  const Addresses addresses_;
  std::set<std::string> known_;
};

}  // namespace liloc::wire
