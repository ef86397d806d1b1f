#pragma once
// Randomness that is the same on every machine: std distributions differ between libraries, these do not.
#include <cmath>
#include <cstdint>

namespace liloc::sim {

/// A good 64-bit hash (the finalizer of splitmix64): neighbouring inputs give unrelated outputs.
[[nodiscard]] inline std::uint64_t mix(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

/// A stream of numbers; each part of the simulator takes its own, so that one part's change leaves others
/// alone.
class Random {
 public:
  Random(std::uint64_t seed, std::uint64_t stream) : state_(mix(seed ^ mix(stream))) {}

  [[nodiscard]] double unit() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * unit(); }
  [[nodiscard]] int below(int count) { return static_cast<int>(unit() * count); }
  [[nodiscard]] bool chance(double probability) { return unit() < probability; }
  [[nodiscard]] double normal() {  // Box-Muller
    return std::sqrt(-2.0 * std::log(1.0 - unit())) * std::cos(6.283185307179586 * unit());
  }

 private:
  std::uint64_t next() { return mix(state_++); }
  std::uint64_t state_;
};

}  // namespace liloc::sim
