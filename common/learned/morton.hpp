#pragma once
#include <cstdint>

namespace liloc::learned {

/// Of three numbers of 21 bits each: bit i of x, y and z becomes bit 3i, 3i + 1 and 3i + 2.
struct Morton {
  std::uint32_t x = 0, y = 0, z = 0;
};

[[nodiscard]] constexpr std::uint64_t spread_bits(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffff;
  v = (v | v << 16) & 0x1f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  return (v | v << 2) & 0x1249249249249249;
}

[[nodiscard]] constexpr std::uint32_t gather_bits(std::uint64_t v) {
  v &= 0x1249249249249249;
  v = (v | v >> 2) & 0x10c30c30c30c30c3;
  v = (v | v >> 4) & 0x100f00f00f00f00f;
  v = (v | v >> 8) & 0x1f0000ff0000ff;
  v = (v | v >> 16) & 0x1f00000000ffff;
  return static_cast<std::uint32_t>((v | v >> 32) & 0x1fffff);
}

[[nodiscard]] constexpr std::uint64_t morton_code(const Morton& m) {
  return spread_bits(m.x) | spread_bits(m.y) << 1 | spread_bits(m.z) << 2;
}

[[nodiscard]] constexpr Morton morton_decoded(std::uint64_t code) {
  return {gather_bits(code), gather_bits(code >> 1), gather_bits(code >> 2)};
}

}  // namespace liloc::learned
