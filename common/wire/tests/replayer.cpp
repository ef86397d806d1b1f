// Whoever is on the wire, without any library of DDS: records packets and sends them again.
#include <arpa/inet.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <netinet/ip.h>
#include <netinet/udp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <optional>
#include <thread>
#include <vector>

#include "common/wire/dds/participant.hpp"
#include "common/wire/tests/site_processes.hpp"

namespace liloc::wire {
namespace {

using namespace std::chrono_literals;
struct Packet {
  int port = 0;
  std::vector<unsigned char> bytes;
};

/// What of an Ethernet frame is for `port`, where discovery comes, or the next one, for data, by UDP over IPv4.
std::optional<Packet> payload_for(int port, const unsigned char* frame, std::size_t size) {
  iphdr ip{};
  udphdr udp{};
  if (size < ETH_HLEN + sizeof ip + sizeof udp) return std::nullopt;
  std::memcpy(&ip, frame + ETH_HLEN, sizeof ip);
  const std::size_t at = ETH_HLEN + 4U * ip.ihl;
  if (ip.version != 4 || ip.protocol != IPPROTO_UDP || size < at + sizeof udp) return std::nullopt;
  std::memcpy(&udp, frame + at, sizeof udp);
  const int to = ntohs(udp.dest);
  if (to != port && to != port + 1) return std::nullopt;
  return Packet{to, {frame + at + sizeof udp, frame + size}};
}

/// Of what crosses now; nothing where nothing does.
std::optional<Packet> next_for(int port, int ear) {
  static std::vector<unsigned char> frame(70'000);
  const ssize_t size = recv(ear, frame.data(), frame.size(), MSG_DONTWAIT);
  if (size > 0) return payload_for(port, frame.data(), static_cast<std::size_t>(size));
  std::this_thread::sleep_for(1ms);
  return std::nullopt;
}

std::vector<Packet> record(int ear, int port) {
  std::vector<Packet> packets;
  for (const auto end = std::chrono::steady_clock::now() + 1s; std::chrono::steady_clock::now() < end;)
    if (auto packet = next_for(port, ear)) packets.push_back(std::move(*packet));
  return packets;
}

/// An ear at the loopback interface; without the right to, it says so and waits for its end.
int open_ear(Tally& tally) {
  const int ear = socket(AF_PACKET, SOCK_RAW, htons(ETH_P_ALL));
  if (ear < 0) ++tally.refused;
  tally.tries = true;
  if (ear >= 0) return ear;
  for (;;) pause();
}

}  // namespace

void read_packets(int domain, Tally& tally) {
  const int ear = open_ear(tally);
  for (;;) {
    const auto packet = next_for(server_port(domain), ear);
    if (!packet) continue;
    ++tally.statuses;
    const auto& bytes = packet->bytes;
    if (std::search(bytes.begin(), bytes.end(), kPlainText.begin(), kPlainText.end()) != bytes.end())
      ++tally.overheard;
  }
}

void replay_packets(int domain, Tally& tally) {
  const int port = server_port(domain);
  const int ear = open_ear(tally);
  std::vector<Packet> packets;
  while (packets.empty()) packets = record(ear, port);
  close(ear);
  const int mouth = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto send = [&](const Packet& packet) {
    to.sin_port = htons(static_cast<std::uint16_t>(packet.port));
    if (sendto(mouth, packet.bytes.data(), packet.bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to),
               sizeof to) > 0)
      ++tally.overheard;
  };
  for (std::size_t altered = 20;; altered += 7)  // beyond the header of RTPS; by hand
    for (Packet packet : packets) {
      send(packet);
      packet.bytes[altered % packet.bytes.size()] ^= 0x5A;
      send(packet);
      std::this_thread::sleep_for(200us);
    }
}

}  // namespace liloc::wire
