#include "proto-tests/replay/processes.hpp"

#include <fcntl.h>
#include <netinet/in.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstring>
#include <deque>
#include <fstream>
#include <thread>
#include <utility>

#include "common/base/stop_signals.hpp"
#include "common/wire/dds/participant.hpp"

extern char** environ;

namespace liloc::replay {
namespace {

std::optional<StopSignals> stop_signals;  // made before the program's first thread, never changed again
std::atomic<bool> stop_came{false};

/// File actions of posix_spawn, freed on every way out.
struct SpawnSetup {
  posix_spawn_file_actions_t actions{};
  posix_spawnattr_t attributes{};
  SpawnSetup() {
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
  }
  SpawnSetup(const SpawnSetup&) = delete;
  SpawnSetup& operator=(const SpawnSetup&) = delete;
  ~SpawnSetup() {
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
  }
};

}  // namespace

Child::Child(pid_t pid, std::string name, std::filesystem::path log_file)
    : pid_(pid), name_(std::move(name)), log_file_(std::move(log_file)) {}

Child::Child(Child&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      name_(std::move(other.name_)),
      log_file_(std::move(other.log_file_)),
      wait_status_(other.wait_status_),
      usage_(other.usage_) {}

Child& Child::operator=(Child&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(name_, other.name_);
  std::swap(log_file_, other.log_file_);
  std::swap(wait_status_, other.wait_status_);
  std::swap(usage_, other.usage_);
  return *this;
}

Child::~Child() {
  (void)stop();
}

Result<Child> Child::start(const std::vector<std::string>& command, const std::filesystem::path& log_file) {
  SpawnSetup setup;
  posix_spawn_file_actions_addopen(&setup.actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&setup.actions, STDOUT_FILENO, log_file.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&setup.actions, STDOUT_FILENO, STDERR_FILENO);
  // Its own process group: Ctrl-C reaches the owner alone, which then stops its children in order.
  // It does not inherit that stop signals are blocked here.
  posix_spawnattr_setflags(&setup.attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
  posix_spawnattr_setpgroup(&setup.attributes, 0);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&setup.attributes, &none);

  std::vector<char*> arguments;
  arguments.reserve(command.size() + 1);
  for (const std::string& part : command) arguments.push_back(const_cast<char*>(part.c_str()));
  arguments.push_back(nullptr);
  pid_t pid = -1;
  const int error =
      posix_spawn(&pid, command.front().c_str(), &setup.actions, &setup.attributes, arguments.data(), environ);
  const std::string name = std::filesystem::path(command.front()).filename();
  if (error != 0)
    return fail("{}: cannot be started ({}); build it, or install it beside liloc", command.front(),
                std::strerror(error));
  return Child(pid, name, log_file);
}

bool Child::running() {
  if (pid_ < 0 || wait_status_) return false;
  reap(WNOHANG);
  return !wait_status_;
}

void Child::reap(int wait_options) {
  int status = 0;
  rusage used{};
  if (wait4(pid_, &status, wait_options, &used) != pid_) return;
  wait_status_ = status;
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  usage_ = {seconds(used.ru_utime) + seconds(used.ru_stime), static_cast<double>(used.ru_maxrss) / 1024};
}

void Child::wait_for(std::chrono::milliseconds limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (running() && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

void Child::ask_to_stop() {
  if (running()) kill(pid_, SIGTERM);
}

Status Child::stop(std::chrono::milliseconds grace) {
  if (pid_ < 0) return {};
  const bool asked = running();
  ask_to_stop();
  wait_for(grace);
  if (running()) {
    kill(pid_, SIGKILL);
    reap(0);
  }
  pid_ = -1;
  const int status = wait_status_.value_or(0);
  const bool obeyed = asked && WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM;  // before it had a handler
  if (obeyed || (WIFEXITED(status) && WEXITSTATUS(status) == 0)) return {};
  return tl::unexpected(failure());
}

Error Child::failure() const {
  std::string how = "ended";
  if (wait_status_ && WIFEXITED(*wait_status_))
    how = fmt::format("ended with exit code {}", WEXITSTATUS(*wait_status_));
  if (wait_status_ && WIFSIGNALED(*wait_status_))
    how = fmt::format("was ended by signal {}", WTERMSIG(*wait_status_));
  const std::string lines = last_lines(log_file_, 3);
  return {fmt::format("{} {}; its last lines in {}: {}", name_, how, log_file_.string(),
                      lines.empty() ? "none" : lines)};
}

std::string last_lines(const std::filesystem::path& file, std::size_t count) {
  std::ifstream in(file);
  std::deque<std::string> lines;
  for (std::string line; std::getline(in, line);) {
    if (line.empty()) continue;
    lines.push_back(line);
    if (lines.size() > count) lines.pop_front();
  }
  std::string joined;
  for (const std::string& line : lines) joined += (joined.empty() ? "" : " | ") + line;
  return joined;
}

Result<int> free_domain() {
  // Beyond domain 100 lie the ephemeral ports.
  const int first = static_cast<int>(getpid()) % 40;
  for (int i = 0; i < 40; ++i) {
    const int domain = 60 + (first + i) % 40;
    const int handle = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (handle < 0) break;
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(wire::server_port(domain)));
    const int bound = bind(handle, reinterpret_cast<const sockaddr*>(&address), sizeof address);
    close(handle);
    if (bound == 0) return domain;
  }
  return fail("DDS: no domain from 60 to 99 is free on this machine; end other replays, or use --lockstep");
}

std::filesystem::path program_folder() {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? std::filesystem::current_path() : self.parent_path();
}

void catch_stop_signals() {
  stop_signals.emplace();
}

bool stop_requested() {
  if (!stop_came && stop_signals && stop_signals->within(std::chrono::milliseconds(0)) != 0) stop_came = true;
  return stop_came;
}

}  // namespace liloc::replay
