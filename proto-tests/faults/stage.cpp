#include "proto-tests/faults/stage.hpp"

#include <sys/mount.h>
#include <sys/ptrace.h>
#include <sys/wait.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>

namespace liloc::faults {
namespace {

namespace fs = std::filesystem;

constexpr int kDomain = 7;            // the network is nobody else's
constexpr char kWorker[] = "worker";  // as server/service names its threads

/// Stops one thread of a child process; it goes on when this process ends.
Status stop_thread(pid_t thread) {
  if (ptrace(PTRACE_SEIZE, thread, nullptr, nullptr) != 0 ||
      ptrace(PTRACE_INTERRUPT, thread, nullptr, nullptr) != 0)
    return fail("a thread of liloc-server cannot be stopped: {}; ptrace must be permitted",
                std::strerror(errno));
  waitpid(thread, nullptr, __WALL);
  return {};
}

std::vector<std::string> hosts_of(const StageOptions& options) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < options.servers; ++i) names.push_back(server_name(i));
  names.insert(names.end(), {kCeiling, kDevice});
  return names;
}

}  // namespace

std::string server_name(std::size_t server) {
  return fmt::format("edge{}", server + 1);
}

Result<std::unique_ptr<Stage>> Stage::open(const StageOptions& options, const Recording& recording) {
  std::unique_ptr<Stage> stage(new Stage(options, recording));
  auto network = BadNetwork::create(hosts_of(options), options.seed);
  if (!network) return tl::unexpected(network.error());
  stage->network_ = std::move(*network);
  std::error_code error;
  fs::create_directories(options.out, error);
  if (error)
    return fail("{}: cannot be made ({}); free the name or the disk", options.out.string(), error.message());
  if (options.small_disk)
    if (const Status opened = stage->open_disk(); !opened) return tl::unexpected(opened.error());
  if (const Status started = stage->start_server(0); !started) return tl::unexpected(started.error());
  return stage;
}

Stage::~Stage() {
  ceiling_.reset();
  device_.reset();
  for (std::size_t i = 0; i < servers_.size(); ++i) kill_server(i);
  if (disk_) umount2((options_.out / "disk").c_str(), MNT_DETACH);
}

Status Stage::open_disk() {
  const fs::path disk = options_.out / "disk";
  std::error_code error;
  fs::create_directories(disk, error);
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=256k") != 0)
    return fail("{}: no disk of our own: {}", disk.string(), std::strerror(errno));
  disk_ = true;
  return {};
}

wire::DomainOptions Stage::seat(wire::Role role) const {
  wire::DomainOptions seat;
  seat.domain = kDomain;
  seat.role = role;
  seat.interface = kInterface;
  for (std::size_t i = 0; i < options_.servers; ++i) seat.peers.push_back(BadNetwork::address(i));
  return seat;
}

Status Stage::start_server(std::size_t server) {
  const fs::path folder = disk_ ? options_.out / "disk" : options_.out;
  const std::string name = server_name(server);
  std::vector<std::string> command{options_.programs / "liloc-server",
                                   "--site",
                                   recording_.root / "site.json",
                                   "--domain",
                                   std::to_string(kDomain),
                                   "--interface",
                                   kInterface,
                                   "--server-id",
                                   name,
                                   "--state",
                                   folder / (name + ".state.json")};
  if (disk_) command.insert(command.end(), {"--save-answers", (folder / "answers").string() + ":all"});
  Result<replay::Child> child = fail("not started");
  network_->host(name).within([&] { child = replay::Child::start(command, folder / (name + ".log")); });
  if (!child) return tl::unexpected(child.error());
  servers_[server] = std::move(*child);
  return {};
}

void Stage::kill_server(std::size_t server) {
  if (!servers_[server]) return;
  kill(servers_[server]->pid(), SIGKILL);
  // A process whose threads are traced ends once the tracer has seen them end.
  for (const pid_t thread : hung_[server]) waitpid(thread, nullptr, __WALL);
  hung_[server].clear();
  (void)servers_[server]->stop();
  servers_[server].reset();
}

void Stage::freeze_server(std::size_t server) {
  kill(servers_[server]->pid(), SIGSTOP);
}

void Stage::thaw_server(std::size_t server) {
  kill(servers_[server]->pid(), SIGCONT);
}

void Stage::freeze_device() {
  kill(device_->pid(), SIGSTOP);
}

void Stage::thaw_device() {
  kill(device_->pid(), SIGCONT);
}

Status Stage::hang_workers(std::size_t server) {
  const fs::path threads = fmt::format("/proc/{}/task", servers_[server]->pid());
  for (const auto& thread : fs::directory_iterator(threads)) {
    std::string name;
    std::getline(std::ifstream(thread.path() / "comm"), name);
    if (name != kWorker) continue;
    const pid_t id = std::stoi(thread.path().filename());
    if (const Status stopped = stop_thread(id); !stopped) return stopped;
    hung_[server].push_back(id);
  }
  return !hung_[server].empty() ? Status{} : fail("{}: no thread is named {}", threads.string(), kWorker);
}

Status Stage::fill_disk() {
  std::ofstream filler(options_.out / "disk" / "filler", std::ios::binary);
  const std::string block(4096, 'x');
  for (int i = 0; i < 1000 && filler; ++i) filler << block << std::flush;
  return filler ? fail("{}: it does not become full", (options_.out / "disk").string()) : Status{};
}

Status Stage::change_device_address(const std::string& address) {
  return network_->host(kDevice).change_address(address);
}

Status Stage::check() {
  for (auto& server : servers_)
    if (server && !server->running()) return tl::unexpected(server->failure());
  return {};
}

Status Stage::begin(const Performance& performance) {
  const auto start = [&](const char* host, const std::function<Result<std::string>()>& part,
                         std::optional<load::Forked>& process) -> Status {
    Status started;
    network_->host(host).within([&] {
      auto forked = load::Forked::start(part);
      if (forked)
        process.emplace(std::move(*forked));
      else
        started = tl::unexpected(forked.error());
    });
    return started;
  };
  const Status ceiling = start(
      kCeiling, [&] { return play_ceiling(performance, seat(wire::Role::source)); }, ceiling_);
  if (!ceiling) return ceiling;
  const fs::path traces = options_.out / kDevice;
  std::error_code error;
  fs::create_directories(traces, error);
  if (error)
    return fail("{}: cannot be made ({}); free the name or the disk", traces.string(), error.message());
  const auto device = [&] { return play_device(performance, seat(wire::Role::client), traces); };
  return start(kDevice, device, device_);
}

Result<DeviceStory> Stage::end() {
  const auto told = device_->collect();
  if (!told) return tl::unexpected(told.error());
  if (const auto played = ceiling_->collect(); !played) return tl::unexpected(played.error());
  return story_from(*told);
}

}  // namespace liloc::faults
