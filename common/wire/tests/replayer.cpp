// Whoever is on the wire, without any library of DDS: records packets and sends them again.
#include <arpa/inet.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <netinet/ip.h>
#include <netinet/udp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>
#include <optional>
#include <thread>
#include <vector>

#include "site_processes.hpp"

namespace liloc::wire {
namespace {

using namespace std::chrono_literals;
using Packet = std::vector<unsigned char>;

/// What of an Ethernet frame is for `port` by UDP over IPv4.
std::optional<Packet> payload_for(int port, const unsigned char* frame, std::size_t size) {
  iphdr ip{};
  udphdr udp{};
  if (size < ETH_HLEN + sizeof ip + sizeof udp) return std::nullopt;
  std::memcpy(&ip, frame + ETH_HLEN, sizeof ip);
  const std::size_t at = ETH_HLEN + 4U * ip.ihl;
  if (ip.version != 4 || ip.protocol != IPPROTO_UDP || size < at + sizeof udp) return std::nullopt;
  std::memcpy(&udp, frame + at, sizeof udp);
  if (ntohs(udp.dest) != port) return std::nullopt;
  return Packet(frame + at + sizeof udp, frame + size);
}

std::vector<Packet> record(int socket, int port) {
  std::vector<Packet> packets;
  std::vector<unsigned char> frame(70'000);
  for (const auto end = std::chrono::steady_clock::now() + 1s; std::chrono::steady_clock::now() < end;) {
    const ssize_t size = recv(socket, frame.data(), frame.size(), MSG_DONTWAIT);
    if (size <= 0)
      std::this_thread::sleep_for(1ms);
    else if (auto payload = payload_for(port, frame.data(), static_cast<std::size_t>(size)))
      packets.push_back(std::move(*payload));
  }
  return packets;
}

}  // namespace

void replay_packets(int domain, Tally& tally) {
  const int port = 7410 + 250 * domain;  // of the server, as common/wire/profile.cpp
  const int ear = socket(AF_PACKET, SOCK_RAW, htons(ETH_P_ALL));
  tally.tries = true;
  if (ear < 0) {
    ++tally.refused;
    for (;;) pause();
  }
  const std::vector<Packet> packets = record(ear, port);
  close(ear);
  const int mouth = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const auto send = [&](const Packet& packet) {
    if (sendto(mouth, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to) > 0)
      ++tally.overheard;
  };
  for (std::size_t altered = 20;; altered += 7)  // beyond the header of RTPS; by hand
    for (Packet packet : packets) {
      send(packet);
      packet[altered % packet.size()] ^= 0x5A;
      send(packet);
      std::this_thread::sleep_for(200us);
    }
}

}  // namespace liloc::wire
