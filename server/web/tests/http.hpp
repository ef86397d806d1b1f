#pragma once
// A request to a web server on this host, byte by byte as a stranger may send it.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <string>

namespace liloc::test {

/// Sends `request` to 127.0.0.1 and reads until the server closes; empty where nobody listens.
inline std::string answer_to(int port, const std::string& request) {
  const int handle = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  std::string answer;
  if (connect(handle, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    static_cast<void>(::send(handle, request.data(), request.size(), MSG_NOSIGNAL));
    std::array<char, 4096> part{};
    for (ssize_t n = 0; (n = recv(handle, part.data(), part.size(), 0)) > 0;)
      answer.append(part.data(), static_cast<std::size_t>(n));
  }
  close(handle);
  return answer;
}

inline std::string get(int port, const std::string& path) {
  return answer_to(port, "GET " + path + " HTTP/1.1\r\nHost: here\r\n\r\n");
}

}  // namespace liloc::test
