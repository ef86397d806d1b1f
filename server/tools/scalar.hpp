#pragma once
// Numbers as PLY and PCD files store them.
#include <cstddef>
#include <cstdint>

namespace liloc::toolbox {

enum class Scalar : std::uint8_t { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 };

[[nodiscard]] std::size_t bytes_of(Scalar type);

/// The number at `bytes`, of which there are bytes_of(type); `swapped`: in the byte order that is not this
/// machine's.
[[nodiscard]] double read_scalar(Scalar type, const char* bytes, bool swapped);

}  // namespace liloc::toolbox
