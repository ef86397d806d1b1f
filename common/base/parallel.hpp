#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace liloc {

/// work(0), work(1), .. work(count - 1), by so many threads, 1..64, the caller's among them. Returns when all
/// is done. Which thread does what is open: results should not depend on it.
template <class Work>
void for_each_index(std::size_t count, int threads, const Work& work) {
  std::atomic<std::size_t> next = 0;
  const auto take = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> pool;
  const std::size_t helpers = std::min(count, static_cast<std::size_t>(std::clamp(threads, 1, 64)));
  for (std::size_t t = 1; t < helpers; ++t) pool.emplace_back(take);
  take();
}

}  // namespace liloc
