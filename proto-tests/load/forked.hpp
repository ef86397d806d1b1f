#pragma once
// Work in processes of their own that share what was computed before, and hand bytes back.
#include <sys/types.h>

#include <functional>
#include <string>

#include "common/base/result.hpp"

namespace liloc::load {

/// A copy of this process that runs one function. It ends with its owner. Not thread-safe.
class Forked {
 public:
  /// Before this process has joined any DDS domain: a copy of DDS's threads' locks is of no use. `work` returns
  /// what it hands back. Errors: the system has no more processes or descriptors.
  [[nodiscard]] static Result<Forked> start(const std::function<Result<std::string>()>& work);
  Forked(Forked&& other) noexcept;
  Forked& operator=(Forked&&) = delete;
  Forked(const Forked&) = delete;
  Forked& operator=(const Forked&) = delete;
  ~Forked();

  /// Waits until it has ended; once. Errors: its own, or it was killed.
  [[nodiscard]] Result<std::string> collect();
  [[nodiscard]] pid_t pid() const { return pid_; }
  /// CPU time, once collected.
  [[nodiscard]] double cpu_s() const { return cpu_s_; }

 private:
  Forked(pid_t pid, int from_child) : pid_(pid), from_child_(from_child) {}
  pid_t pid_;
  int from_child_;
  double cpu_s_ = 0;
};

}  // namespace liloc::load
