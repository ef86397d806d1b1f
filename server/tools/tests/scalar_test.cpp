#include "server/tools/scalar.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "server/tools/tests/cloud_texts.hpp"

namespace liloc::toolbox {
namespace {

template <class T>
void expect_read(Scalar type) {
  EXPECT_EQ(bytes_of(type), sizeof(T));
  for (const T value : {T{0}, T{7}, std::numeric_limits<T>::lowest(), std::numeric_limits<T>::max()})
    for (const bool swapped : {false, true}) {
      const T typed = value;
      std::string bytes(reinterpret_cast<const char*>(&typed), sizeof(T));
      if (swapped) std::reverse(bytes.begin(), bytes.end());
      EXPECT_EQ(read_scalar(type, bytes.data(), swapped), static_cast<double>(value)) << sizeof(T);
    }
}

TEST(Scalar, EachTypeIsReadInBothByteOrders) {
  expect_read<std::int8_t>(Scalar::i8);
  expect_read<std::uint8_t>(Scalar::u8);
  expect_read<std::int16_t>(Scalar::i16);
  expect_read<std::uint16_t>(Scalar::u16);
  expect_read<std::int32_t>(Scalar::i32);
  expect_read<std::uint32_t>(Scalar::u32);
  expect_read<std::int64_t>(Scalar::i64);
  expect_read<std::uint64_t>(Scalar::u64);
  expect_read<float>(Scalar::f32);
  expect_read<double>(Scalar::f64);
}

}  // namespace
}  // namespace liloc::toolbox
