#include "proto-tests/load/forked.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>
#include <utility>

namespace liloc::load {
namespace {

constexpr char kDone = 'd', kFailed = 'f';  // first byte of what comes back

void write_all(int to, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(to, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;  // nobody reads any more
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

Result<std::string> guarded(const std::function<Result<std::string>()>& work) {
  try {
    return work();
  } catch (const std::exception& trouble) {
    return fail("load: {}", trouble.what());
  }
}

[[noreturn]] void be_child(int to_parent, const std::function<Result<std::string>()>& work) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  const Result<std::string> made = guarded(work);
  write_all(to_parent, made ? kDone + *made : kFailed + made.error().message);
  _exit(made ? 0 : 1);  // what the parent holds is the parent's to put away
}

std::string read_all(int from) {
  std::string bytes;
  std::array<char, 65536> buffer;
  for (;;) {
    const ssize_t count = read(from, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return bytes;
    bytes.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

Result<Forked> Forked::start(const std::function<Result<std::string>()>& work) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return fail("no pipe: {}", std::strerror(errno));
  const pid_t pid = fork();
  if (pid == 0) {
    close(ends[0]);
    be_child(ends[1], work);
  }
  close(ends[1]);
  if (pid > 0) return Forked(pid, ends[0]);
  close(ends[0]);
  return fail("no further process: {}", std::strerror(errno));
}

Forked::Forked(Forked&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      from_child_(std::exchange(other.from_child_, -1)),
      cpu_s_(other.cpu_s_) {}

Forked::~Forked() {
  if (from_child_ >= 0) close(from_child_);
  if (pid_ <= 0) return;
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

Result<std::string> Forked::collect() {
  std::string bytes = read_all(from_child_);
  int status = 0;
  rusage usage{};
  while (wait4(pid_, &status, 0, &usage) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  cpu_s_ = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  if (WIFSIGNALED(status)) return fail("a process of this run was killed by signal {}", WTERMSIG(status));
  if (bytes.empty()) return fail("a process of this run ended without a word");
  const bool done = bytes.front() == kDone;
  bytes.erase(0, 1);
  if (!done) return fail("{}", bytes);
  return bytes;
}

}  // namespace liloc::load
