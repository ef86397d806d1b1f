#pragma once
// Work in processes of their own that share what was computed before, and hand bytes back.
#include <sys/types.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

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

/// What a process hands back, in this program's own layout: rows of plain data.
template <class Row>
void append_rows(const std::vector<Row>& rows, std::string& bytes) {
  static_assert(std::is_trivially_copyable_v<Row>);
  const std::uint64_t count = rows.size();
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  bytes.append(reinterpret_cast<const char*>(rows.data()), count * sizeof(Row));
}

/// Puts them after `rows` and takes them off `bytes`, which are of `append_rows` alone.
template <class Row>
void take_rows(std::string_view& bytes, std::vector<Row>& rows) {
  static_assert(std::is_trivially_copyable_v<Row>);
  std::uint64_t count = 0;
  std::memcpy(&count, bytes.data(), sizeof count);
  const std::size_t before = rows.size();
  rows.resize(before + count);
  if (count > 0) std::memcpy(rows.data() + before, bytes.data() + sizeof count, count * sizeof(Row));
  bytes.remove_prefix(sizeof count + count * sizeof(Row));
}

}  // namespace liloc::load
