#pragma once
#include <string>

#include "common/base/result.hpp"

namespace liloc::web {

/// Where a server listens.
struct Address {
  std::string host = "127.0.0.1";  ///< a numeric address of IPv4 or IPv6
  int port = 0;                    ///< 0: a free one
  bool operator==(const Address&) const = default;
};
/// PORT (on loopback), ADDRESS:PORT or [IPV6]:PORT, port 1..65535. The error says what is wrong with the text.
[[nodiscard]] Result<Address> address_from(const std::string& text);
/// ADDRESS:PORT or [IPV6]:PORT.
[[nodiscard]] std::string text_of(const Address& address);

/// Error: the host is no numeric address.
[[nodiscard]] Status check(const Address& address);
/// Whether nobody on another host reaches it.
[[nodiscard]] bool is_loopback(const Address& address);

}  // namespace liloc::web
