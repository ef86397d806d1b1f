#include "proto-tests/replay/fleet.hpp"

#include <thread>

namespace liloc::replay {
namespace {

std::vector<std::string> joined(std::vector<std::string> command, const std::vector<std::string>& more) {
  command.insert(command.end(), more.begin(), more.end());
  return command;
}

}  // namespace

Result<Fleet> Fleet::start(const FleetCommand& command) {
  Fleet fleet;
  const std::string domain = std::to_string(command.domain);
  auto server =
      Child::start(joined({command.programs / "liloc-server", "--site", command.site_file, "--domain", domain},
                          command.server_arguments),
                   command.server_log);
  if (!server) return tl::unexpected(server.error());
  fleet.server_.push_back(std::move(*server));
  for (const ClientCommand& client : command.clients) {
    std::error_code error;
    std::filesystem::create_directories(client.trace_folder, error);
    if (error)
      return fail("{}: cannot be made ({}); free the name or the disk", client.trace_folder.string(),
                  error.message());
    auto child = Child::start(joined({command.programs / "liloc-client", "--id", client.id, "--domain", domain,
                                      "--device", client.device_file, "--trace", client.trace_folder},
                                     client.arguments),
                              client.trace_folder / "client.log");
    if (!child) return tl::unexpected(child.error());
    fleet.clients_.push_back(std::move(*child));
  }
  return fleet;
}

Status Fleet::check() {
  for (auto* group : {&server_, &clients_})
    for (Child& child : *group)
      if (!child.running()) return tl::unexpected(child.failure());
  return {};
}

Status Fleet::wait_until(const std::function<bool()>& ready, std::chrono::milliseconds limit,
                         std::string_view what) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!ready()) {
    if (auto status = check(); !status) return status;
    if (stop_requested()) return fail("stopped by a signal while waiting for {}", what);
    if (std::chrono::steady_clock::now() > deadline)
      return fail("{}: not there after {} ms; is another program on this DDS domain?", what, limit.count());
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return {};
}

Status Fleet::stop() {
  Status first;
  for (auto* group : {&clients_, &server_}) {
    for (Child& child : *group) child.ask_to_stop();
    for (Child& child : *group)
      if (auto status = child.stop(); !status && first) first = status;
    if (group == &clients_)
      for (const Child& child : clients_) client_usage_.push_back(child.usage());
    group->clear();
  }
  return first;
}

}  // namespace liloc::replay
