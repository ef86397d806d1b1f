#include "server/web/address.hpp"

#include <arpa/inet.h>

#include <charconv>
#include <string_view>
#include <system_error>

namespace liloc::web {
namespace {

bool is_v6(const std::string& host) {
  return host.find(':') != std::string::npos;
}

}  // namespace

Result<Address> address_from(const std::string& text) {
  Address address;
  std::string_view port = text;
  if (const auto colon = text.rfind(':'); colon != std::string::npos) {
    address.host = text.substr(0, colon);
    port.remove_prefix(colon + 1);
    const bool bracketed = address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']';
    if (bracketed) address.host = address.host.substr(1, address.host.size() - 2);
    if (!check(address) || bracketed != is_v6(address.host))
      return fail("give PORT, ADDRESS:PORT or [IPV6]:PORT with a numeric address, as 0.0.0.0:9464");
  }
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
  if (error != std::errc{} || end != port.data() + port.size() || address.port < 1 || address.port > 65'535)
    return fail("give PORT, ADDRESS:PORT or [IPV6]:PORT with a port of 1..65535");
  return address;
}

std::string text_of(const Address& address) {
  return fmt::format("{}:{}", is_v6(address.host) ? "[" + address.host + "]" : address.host, address.port);
}

Status check(const Address& address) {
  in6_addr parsed{};
  if (inet_pton(is_v6(address.host) ? AF_INET6 : AF_INET, address.host.c_str(), &parsed) == 1) return {};
  return fail("'{}' is no numeric address", address.host);
}

bool is_loopback(const Address& address) {
  in_addr v4{};
  if (inet_pton(AF_INET, address.host.c_str(), &v4) == 1) return ntohl(v4.s_addr) >> 24 == IN_LOOPBACKNET;
  in6_addr v6{};
  return inet_pton(AF_INET6, address.host.c_str(), &v6) == 1 && IN6_IS_ADDR_LOOPBACK(&v6) != 0;
}

}  // namespace liloc::web
