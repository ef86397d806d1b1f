#include "proto-tests/inputs/server_process.hpp"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <thread>

#include "server/web/tests/http.hpp"

namespace liloc::inputs {
namespace {

/// A port that nobody listens on right now; 0 where there is none.
int free_port() {
  const int handle = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  const bool bound = bind(handle, reinterpret_cast<const sockaddr*>(&address), size) == 0 &&
                     getsockname(handle, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  close(handle);
  return bound ? ntohs(address.sin_port) : 0;
}

}  // namespace

Result<std::unique_ptr<ServerProcess>> ServerProcess::start(int domain, const std::filesystem::path& site_file,
                                                            const std::filesystem::path& log_file) {
  std::unique_ptr<ServerProcess> server(new ServerProcess);
  server->metrics_port_ = free_port();
  auto child = replay::Child::start(
      {LILOC_SERVER, "--site", site_file.string(), "--domain", std::to_string(domain), "--server-id", "edge",
       "--state", "none", "--metrics", std::to_string(server->metrics_port_)},
      log_file);
  if (!child) return tl::unexpected(child.error());
  server->child_ = std::move(*child);
  auto seat = wire::Participant::create({.domain = domain});
  if (!seat) return tl::unexpected(seat.error());
  server->seat_ = std::move(*seat);
  auto dispatcher = wire::Dispatcher::create(*server->seat_);
  if (!dispatcher) return tl::unexpected(dispatcher.error());
  server->dispatcher_ = std::move(*dispatcher);
  const Status subscribed = wire::subscribe_status(
      *server->dispatcher_, [raw = server.get()](const Result<wire::ServerStatus>& status) {
        if (!status || status->server_id != "edge") return;
        const std::scoped_lock lock(raw->mutex_);
        raw->status_ = *status;
      });
  if (!subscribed) return tl::unexpected(subscribed.error());
  server->dispatcher_->start();
  return server;
}

std::optional<wire::ServerStatus> ServerProcess::status() const {
  const std::scoped_lock lock(mutex_);
  return status_;
}

wire::LidarHealth ServerProcess::lidar(std::size_t index) const {
  const auto now = status();
  return now && index < now->lidars.size() ? now->lidars[index] : wire::LidarHealth{};
}

std::string ServerProcess::page(const std::string& path) const {
  return test::get(metrics_port_, path);
}

double ServerProcess::peak_mb() const {
  std::ifstream in("/proc/" + std::to_string(child_->pid()) + "/status");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
  return 0;
}

}  // namespace liloc::inputs
