#include "common/codec/range_coder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace liloc::codec {
namespace {

class RangeCoderLaw : public testing::TestWithParam<unsigned> {};

/// Bits of which `share` are set, each by one of three models, every ninth by none.
template <class Coder>
std::vector<bool> code(Coder& coder, const std::vector<bool>& bits) {
  std::array<BitModel, 3> models;
  std::vector<bool> said;
  for (std::size_t i = 0; i < bits.size(); ++i)
    said.push_back(i % 9 == 0 ? coder.plain_bit(bits[i]) : coder.bit(models[i % 3], bits[i]));
  return said;
}

std::vector<bool> some_bits(unsigned seed, double share, std::size_t count) {
  std::mt19937_64 rng(seed);
  std::bernoulli_distribution set(share);
  std::vector<bool> bits(count);
  for (auto&& bit : bits) bit = set(rng);
  return bits;
}

TEST_P(RangeCoderLaw, WhatIsWrittenIsReadAndUsesTheStreamUp) {
  for (const double share : {0.0, 0.001, 0.3, 0.5, 0.97, 1.0})
    for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{20'000}}) {
      const std::vector<bool> bits = some_bits(GetParam(), share, count);
      RangeEncoder encoder;
      EXPECT_EQ(code(encoder, bits), bits) << "an encoder says what it writes";
      const std::vector<std::uint8_t> bytes = encoder.finish();
      RangeDecoder decoder(bytes.data(), bytes.data() + bytes.size());
      EXPECT_EQ(code(decoder, std::vector<bool>(count)), bits) << share << " of " << count;
      EXPECT_TRUE(decoder.used_up());
      EXPECT_FALSE(decoder.cut_short());
    }
}

TEST_P(RangeCoderLaw, ABitCostsWhatItsProbabilitySays) {
  constexpr std::size_t kBits = 50'000;
  for (const double asked : {0.02, 0.2, 0.5}) {
    RangeEncoder encoder;
    BitModel model;
    const std::vector<bool> all = some_bits(GetParam(), asked, kBits);
    for (const bool bit : all) encoder.bit(model, bit);
    const double share = static_cast<double>(std::ranges::count(all, true)) / kBits;
    const double entropy = -share * std::log2(share) - (1 - share) * std::log2(1 - share);
    const double bits = 8.0 * static_cast<double>(encoder.finish().size()) / kBits;
    EXPECT_GT(bits, 0.97 * entropy);
    // A mean of the last fifty errs by p (1 - p) / 99 squared: that costs 1 / (198 ln 2) of a bit.
    EXPECT_LT(bits, entropy + 0.012);
  }
}

TEST_P(RangeCoderLaw, ACutStreamIsNoticedAndALongerOneIsNotUsedUp) {
  const std::vector<bool> bits = some_bits(GetParam(), 0.3, 5000);
  RangeEncoder encoder;
  code(encoder, bits);
  std::vector<std::uint8_t> bytes = encoder.finish();
  RangeDecoder cut(bytes.data(), bytes.data() + bytes.size() - 1);
  code(cut, bits);
  EXPECT_TRUE(cut.cut_short());
  EXPECT_FALSE(cut.used_up());
  bytes.push_back(0);
  RangeDecoder longer(bytes.data(), bytes.data() + bytes.size());
  code(longer, bits);
  EXPECT_FALSE(longer.cut_short());
  EXPECT_FALSE(longer.used_up());
}

INSTANTIATE_TEST_SUITE_P(Seeds, RangeCoderLaw, testing::Range(1U, 6U));

TEST(BitModel, LearnsASteadyBitAndNeverTakesItForCertain) {
  BitModel set, unset;
  for (int i = 0; i < 10'000; ++i) set.learn(true), unset.learn(false);
  EXPECT_GT(set.one(), 65'000U);
  EXPECT_LT(set.one(), 65'536U);
  EXPECT_GT(unset.one(), 0U);
  EXPECT_LT(unset.one(), 600U);
}

}  // namespace
}  // namespace liloc::codec
