#pragma once
#include <functional>
#include <set>
#include <string>

namespace liloc::wire {

/// IPv4 addresses of an interface by its name, of all but the loopback for "auto"; the address itself where one
/// is given and some interface has it. Empty where there are none now.
[[nodiscard]] std::set<std::string> addresses_of(const std::string& interface);

/// Notices that DDS has to join the network anew: it reads addresses when a participant is made, tells them to
/// all others, and never again. Not thread-safe.
class AddressWatch {
 public:
  using Addresses = std::function<std::set<std::string>()>;
  /// To be made just before a participant is.
  explicit AddressWatch(Addresses addresses) : addresses_(std::move(addresses)), joined_(addresses_()) {}

  /// Whether to join anew now, over what there is now; once for each change, and not while there is no address.
  /// So it is where an address of those at the last join is gone (nobody knows which of them DDS uses), and,
  /// where no server is `reached` over those, also where another has come: "auto" takes what there is, as a
  /// bridge for containers before the radio is up. One that came later and is gone again was never used.
  [[nodiscard]] bool changed(bool reached);

 private:
  const Addresses addresses_;
  std::set<std::string> joined_;  ///< with which DDS joined last
};

}  // namespace liloc::wire
