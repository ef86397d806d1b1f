#include "common/wire/dds/address_watch.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

namespace liloc::wire {
namespace {

std::string text_of(const sockaddr* address) {
  std::array<char, INET_ADDRSTRLEN> text{};
  const auto* ipv4 = reinterpret_cast<const sockaddr_in*>(address);
  return inet_ntop(AF_INET, &ipv4->sin_addr, text.data(), text.size()) != nullptr ? text.data() : "";
}

bool is_asked_for(const ifaddrs& entry, const std::string& address, const std::string& interface) {
  if ((entry.ifa_flags & IFF_UP) == 0U) return false;
  if (interface == "auto") return (entry.ifa_flags & IFF_LOOPBACK) == 0U;
  return interface == entry.ifa_name || interface == address;
}

}  // namespace

std::set<std::string> addresses_of(const std::string& interface) {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owned(list, &freeifaddrs);
  std::set<std::string> found;
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    if (entry->ifa_addr == nullptr || entry->ifa_addr->sa_family != AF_INET) continue;
    std::string address = text_of(entry->ifa_addr);
    if (is_asked_for(*entry, address, interface)) found.insert(std::move(address));
  }
  return found;
}

bool AddressWatch::changed(bool reached) {
  std::set<std::string> now = addresses_();
  if (now.empty()) return false;  // it is between two networks
  const bool gone = !std::ranges::includes(now, joined_), come = !std::ranges::includes(joined_, now);
  if (!gone && (reached || !come)) return false;
  joined_ = std::move(now);
  return true;
}

}  // namespace liloc::wire
