// The profile of the star, with the values that notes on Cyclone DDS 0.10 found to carry 400 clients.
#include <algorithm>
#include <cctype>
#include <fstream>

#include "common/base/log.hpp"
#include "common/wire/dds/participant.hpp"

namespace liloc::wire {
namespace {

constexpr int kMaxDomain = 230;  // ports of a higher domain exceed 65535

/// A name or an address goes into XML as it is: no quote, bracket or blank may pass.
bool plain(std::string_view text) {
  return !text.empty() && text.size() < 128 && std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == ':' || c == '-' || c == '_' || c == '%' || c == '[' ||
           c == ']';
  });
}

bool is_address(const std::string& interface) {
  return interface.find(':') != std::string::npos ||
         std::ranges::all_of(interface, [](unsigned char c) { return std::isdigit(c) != 0 || c == '.'; });
}

std::string interface_xml(const std::string& interface) {
  if (interface == "auto") return R"(<NetworkInterface autodetermine="true" multicast="false"/>)";
  return fmt::format(R"(<NetworkInterface {}="{}" multicast="false"/>)",
                     is_address(interface) ? "address" : "name", interface);
}

std::string peers_xml(const DomainOptions& options) {
  if (options.role == Role::server || options.role == Role::standby) return "";
  std::vector<std::string> hosts = options.peers;
  if (hosts.empty() || options.role == Role::peer) hosts.emplace_back("127.0.0.1");
  std::string xml = "<Peers>";
  for (const auto& host : hosts) {
    if (options.role == Role::peer)
      xml += fmt::format(R"(<Peer address="{}"/>)", host);
    else
      for (const int index : {0, 1, 2})
        xml += fmt::format(R"(<Peer address="{}:{}"/>)", host, server_port(options.domain) + 2 * index);
  }
  return xml + "</Peers>";
}

std::string_view index_of(Role role) {
  switch (role) {
    case Role::server:
      return "0";
    case Role::source:
      return "1";
    case Role::standby:
      return "2";
    case Role::client:
      return "none";
    case Role::peer:
      return "auto";
  }
  return "none";
}

/// How often one tells its peers that it is there, which is how a server that was started anew finds it.
/// Sources are few; 400 clients would cost a server 2 % of a core at the sources' pace, and tell more often
/// when nobody answers (ClientLink::announce).
std::string_view announced_every(Role role) {
  return role == Role::source ? "200ms" : "1s";
}

/// Loopback takes 64 kB datagrams whole. A wired LAN fares best with the defaults: datagrams of 14 kB. Of a
/// device's link, which is radio, each lost frame would cost the whole datagram, so that one fits a frame of
/// Ethernet (1500 bytes less the headers of IP and UDP).
std::string_view fragments_xml(const DomainOptions& options) {
  if (options.interface == "lo")
    return "<MaxMessageSize>65500B</MaxMessageSize><FragmentSize>64000B</FragmentSize>";
  return options.role == Role::client || options.role == Role::peer ? "<MaxMessageSize>1472B</MaxMessageSize>"
                                                                    : "";
}

/// A receiving thread of its own for unicast is woken, to end, by a datagram to the address that it had when it
/// began. Where that is gone the participant never ends (Cyclone 0.10.2, seen when a device roamed); with one
/// thread for all it is woken through a pipe.
std::string_view threads_xml(Role role) {
  return role == Role::client || role == Role::peer ? "<MultipleReceiveThreads>false</MultipleReceiveThreads>"
                                                    : "";
}

/// Participant creation fails where the kernel allows less than the least that is asked for.
int allowed_kb(int wanted_kb, const char* setting, const char* name) {
  std::ifstream file(setting);
  long bytes = 0;
  if (!(file >> bytes) || bytes >= 1024L * wanted_kb) return wanted_kb;
  log::warning("{} is {} bytes, {} kB are wanted; large bursts may be lost. Remedy: sysctl -w {}={}", name,
               bytes, wanted_kb, name, 1024L * wanted_kb);
  return static_cast<int>(bytes / 1024);
}

}  // namespace

int server_port(int domain) {
  return 7410 + 250 * domain;  // DDSI-RTPS 2.2, 9.6.1: PB + DG * domain + d1
}

Status check(const DomainOptions& options) {
  if (options.domain < 0 || options.domain > kMaxDomain)
    return fail("domain is {}, must be 0..{}", options.domain, kMaxDomain);
  if (!plain(options.interface))
    return fail("interface is \"{}\", must be a name, an address or auto", options.interface);
  for (const auto& peer : options.peers)
    if (!plain(peer)) return fail("peer is \"{}\", must be a host name or an address", peer);
  if (options.receive_buffer_kb < 64 || options.receive_buffer_kb > 1'048'576)
    return fail("receive_buffer_kb is {}, must be 64..1048576", options.receive_buffer_kb);
  return {};
}

Result<std::string> profile_xml(const DomainOptions& options) {
  if (const Status ok = check(options); !ok) return tl::unexpected(ok.error());
  const int receive_kb =
      allowed_kb(options.receive_buffer_kb, "/proc/sys/net/core/rmem_max", "net.core.rmem_max");
  const int send_kb = allowed_kb(1024, "/proc/sys/net/core/wmem_max", "net.core.wmem_max");
  return fmt::format(
      R"(<CycloneDDS xmlns="https://cdds.io/config"><Domain Id="any">)"
      R"(<General><Interfaces>{}</Interfaces><AllowMulticast>false</AllowMulticast>{}</General>)"
      R"(<Discovery><ParticipantIndex>{}</ParticipantIndex>{}<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>)"
      R"(<SPDPInterval>{}</SPDPInterval><LeaseDuration>20s</LeaseDuration></Discovery>)"
      R"(<Internal><SocketReceiveBufferSize min="{}kB"/><SocketSendBufferSize min="{}kB"/>)"
      R"(<MaxSampleSize>32MB</MaxSampleSize>{}</Internal></Domain></CycloneDDS>)",
      interface_xml(options.interface), fragments_xml(options), index_of(options.role), peers_xml(options),
      announced_every(options.role), receive_kb, send_kb, threads_xml(options.role));
}

}  // namespace liloc::wire
