#pragma once
// What a bag may make its reader hold at once.
#include <cstddef>

namespace liloc::bags {

/// Writers flush a chunk at 1 to 4 MiB, and the largest depth image has 256 MiB as floats; a chunk or record
/// that says more is damaged, or meant to exhaust the memory.
constexpr std::size_t kLargestChunk = std::size_t{256} << 20;
constexpr std::size_t kLongestName = 1024;   ///< of a topic, type, frame or encoding; by hand
constexpr std::size_t kMostTopics = 10'000;  ///< by hand
constexpr std::size_t kMostSamples =
    10'000'000;  ///< of an IMU: what imu.csv holds in the GiB that is read of it

}  // namespace liloc::bags
