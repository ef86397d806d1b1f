#include "common/codec/voxel.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "common/codec/tests/room_view.hpp"

namespace liloc {
namespace {

constexpr CodecOptions kVoxel{.codec = CloudCodec::voxel};
constexpr std::size_t kVoxelHeaderBytes = 28;

class VoxelSeeds : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, VoxelSeeds, testing::Range(1U, 4U));

// Any cloud is taken, not only one of voxel means.
TEST_P(VoxelSeeds, VoxelKeepsManyPointsOfOneVoxelAndAnyPlace) {
  std::mt19937 random(GetParam());
  std::uniform_real_distribution<float> place(-900, 900), near(-0.2F, 0.2F);
  Cloud cloud;
  for (int i = 0; i < 300; ++i) cloud.points.emplace_back(near(random), near(random), near(random));
  for (int i = 0; i < 50; ++i) cloud.points.emplace_back(place(random), place(random), place(random));
  for (int i = 0; i < 5; ++i) cloud.points.push_back(cloud.points.front());
  for (const double voxel_size_m : {0.01, 0.05, 0.5}) {
    const auto encoded =
        encode(cloud, {.codec = CloudCodec::voxel, .voxel_size_m = voxel_size_m, .resolution_m = 0.02});
    ASSERT_TRUE(encoded) << encoded.error().message;
    const auto decoded = decode(*encoded);
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_EQ(decoded->size(), cloud.size());
    EXPECT_LT(rmse_m(cloud, *decoded), 0.011);
    EXPECT_LT(rmse_m(*decoded, cloud), 0.011);
  }
}

TEST(Voxel, RefusesAVoxelStreamOfAnotherLength) {
  const auto encoded = encode(room_view(7, 300), kVoxel);
  ASSERT_TRUE(encoded);
  EncodedCloud longer = *encoded;
  longer.bytes.push_back(0);
  EXPECT_FALSE(decode(longer));
  for (std::size_t bytes = 0; bytes < encoded->bytes.size(); ++bytes) {
    EncodedCloud cut = *encoded;
    cut.bytes.resize(bytes);
    ASSERT_FALSE(decode(cut)) << bytes;
  }
}

// Noise behind a valid header: what a sender of nonsense can make the server do.
TEST(Voxel, NoiseBehindAVoxelHeaderIsBounded) {
  std::mt19937 random(20'001);
  const auto encoded = encode(room_view(8, 800), kVoxel);
  ASSERT_TRUE(encoded);
  for (int i = 0; i < 500; ++i) {
    EncodedCloud noise = *encoded;
    noise.bytes.resize(kVoxelHeaderBytes + random() % 4'000);
    for (std::size_t at = kVoxelHeaderBytes; at < noise.bytes.size(); ++at)
      noise.bytes[at] = i % 4 == 0 ? 0xFF : static_cast<std::uint8_t>(random());
    const std::uint32_t points = 1 + static_cast<std::uint32_t>(random() % kMaxCodecPoints);
    std::memcpy(noise.bytes.data() + 8, &points, sizeof points);
    const auto decoded = decode(noise);
    if (!decoded) continue;
    ASSERT_EQ(decoded->size(), points);
  }
}

}  // namespace
}  // namespace liloc
