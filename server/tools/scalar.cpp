#include "server/tools/scalar.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace liloc::toolbox {
namespace {

template <class T>
double as(const char* bytes, bool swapped) {
  std::array<char, sizeof(T)> ordered{};
  std::copy_n(bytes, sizeof(T), ordered.begin());
  if (swapped) std::ranges::reverse(ordered);
  return static_cast<double>(std::bit_cast<T>(ordered));
}

}  // namespace

std::size_t bytes_of(Scalar type) {
  constexpr std::array<std::size_t, 10> kBytes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kBytes.at(static_cast<std::size_t>(type));
}

double read_scalar(Scalar type, const char* bytes, bool swapped) {
  switch (type) {
    case Scalar::i8:
      return as<std::int8_t>(bytes, swapped);
    case Scalar::u8:
      return as<std::uint8_t>(bytes, swapped);
    case Scalar::i16:
      return as<std::int16_t>(bytes, swapped);
    case Scalar::u16:
      return as<std::uint16_t>(bytes, swapped);
    case Scalar::i32:
      return as<std::int32_t>(bytes, swapped);
    case Scalar::u32:
      return as<std::uint32_t>(bytes, swapped);
    case Scalar::i64:
      return as<std::int64_t>(bytes, swapped);
    case Scalar::u64:
      return as<std::uint64_t>(bytes, swapped);
    case Scalar::f32:
      return as<float>(bytes, swapped);
    case Scalar::f64:
      return as<double>(bytes, swapped);
  }
  return 0;
}

}  // namespace liloc::toolbox
