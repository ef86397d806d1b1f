#pragma once
#include <chrono>
#include <thread>

namespace liloc::test {

/// Waits until something holds, for so long at most; false: it never did. For what other threads and processes
/// bring about: a bound to fail at, not a time to measure.
template <class Condition>
[[nodiscard]] bool within(std::chrono::milliseconds limit, Condition&& holds) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!holds()) {
    if (std::chrono::steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace liloc::test
