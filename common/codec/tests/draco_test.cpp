#include "common/codec/draco.hpp"

#include <gtest/gtest.h>

#include "common/codec/tests/room_view.hpp"

namespace liloc {
namespace {

class DracoSeeds : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, DracoSeeds, testing::Range(1U, 4U));

TEST_P(DracoSeeds, DracoSaysTheSameTwice) {
  const Cloud cloud = room_view(GetParam());
  const auto encoded = encode(cloud), again = encode(cloud);
  ASSERT_TRUE(encoded && again);
  EXPECT_EQ(encoded->bytes, again->bytes);
}

TEST(Draco, RefusesADracoHeaderWithTwoCounts) {  // else Draco writes past the end of what it allocated
  auto encoded = encode(room_view(5));
  ASSERT_TRUE(encoded);
  encoded->bytes[28] ^= 0x10;
  const auto decoded = decode(*encoded);
  ASSERT_FALSE(decoded);
  EXPECT_NE(decoded.error().message.find("two counts"), std::string::npos);
}

}  // namespace
}  // namespace liloc
