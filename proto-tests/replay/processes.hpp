#pragma once
// The programs that a live run starts: each child ends with its owner, by its own process id.
#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace liloc::replay {

/// A child process whose output goes to a file. The destructor ends it. Not thread-safe.
class Child {
 public:
  /// `command` holds the program's path and its arguments. Errors: it cannot be started.
  [[nodiscard]] static Result<Child> start(const std::vector<std::string>& command,
                                           const std::filesystem::path& log_file);
  Child(Child&& other) noexcept;
  Child& operator=(Child&& other) noexcept;
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child();

  [[nodiscard]] bool running();
  [[nodiscard]] pid_t pid() const { return pid_; }
  /// SIGTERM, then SIGKILL once `grace` is over. Error: the child failed, was killed, or had ended before with
  /// an error; its last log lines are in the message.
  Status stop(std::chrono::milliseconds grace = std::chrono::seconds(5));
  /// Asks it to stop and returns at once, so that many can stop side by side; `stop` then waits.
  void ask_to_stop();
  /// CPU time and most memory of one that has ended; 0 before. Linux counts in what the parent held when it
  /// started the child, so memory is an upper bound.
  struct Usage {
    double cpu_s = 0, peak_mb = 0;
  };
  [[nodiscard]] Usage usage() const { return usage_; }
  /// What went wrong with a child that ended by itself, with its last log lines.
  [[nodiscard]] Error failure() const;

 private:
  Child(pid_t pid, std::string name, std::filesystem::path log_file);
  void wait_for(std::chrono::milliseconds limit);
  void reap(int wait_options);

  pid_t pid_ = -1;
  std::string name_;
  std::filesystem::path log_file_;
  std::optional<int> wait_status_;  ///< set once it has ended
  Usage usage_;
};

/// The last `count` non-empty lines of a file, joined by " | "; empty when there are none.
[[nodiscard]] std::string last_lines(const std::filesystem::path& file, std::size_t count);

/// A DDS domain that no program on this machine uses right now. Error: none is free.
[[nodiscard]] Result<int> free_domain();

/// The folder of the running program, where its siblings are.
[[nodiscard]] std::filesystem::path program_folder();

/// From now on SIGINT and SIGTERM do not end this process; `stop_requested` says that one came. To be called
/// before the program's first thread (`StopSignals`).
void catch_stop_signals();
[[nodiscard]] bool stop_requested();

}  // namespace liloc::replay
