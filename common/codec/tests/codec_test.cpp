#include "common/codec/codec.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "common/codec/tests/room_view.hpp"

namespace liloc {
namespace {

constexpr auto kAll = {CloudCodec::draco, CloudCodec::octree, CloudCodec::voxel};
constexpr CodecOptions kVoxel{.codec = CloudCodec::voxel};

class CodecSeeds : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, CodecSeeds, testing::Values(1, 2, 3));

TEST_P(CodecSeeds, DracoAndVoxelErrByHalfTheirResolution) {
  const Cloud cloud = room_view(GetParam());
  for (const auto codec : {CloudCodec::draco, CloudCodec::voxel})
    for (const double resolution_m : {0.001, 0.003, 0.01}) {
      const auto encoded = encode(cloud, {.codec = codec, .resolution_m = resolution_m});
      ASSERT_TRUE(encoded) << encoded.error().message;
      const auto decoded = decode(*encoded);
      ASSERT_TRUE(decoded) << decoded.error().message;
      EXPECT_EQ(decoded->size(), cloud.size());
      EXPECT_NEAR(rmse_m(cloud, *decoded), 0.5 * resolution_m,
                  0.02 * resolution_m)  // uniform: step * sqrt(3 / 12)
          << name_of(codec) << resolution_m;
    }
}

TEST_P(CodecSeeds, VoxelTakesFewerBytesThanDracoOfTheSameError) {
  const Cloud cloud = room_view(GetParam(), 120'000);
  const auto voxel = encode(cloud, kVoxel), again = encode(cloud, kVoxel), draco = encode(cloud);
  ASSERT_TRUE(voxel && again && draco);
  EXPECT_EQ(draco->codec, CloudCodec::draco);
  EXPECT_LT(voxel->bytes.size(), draco->bytes.size() * 85 / 100) << cloud.size();
  EXPECT_LT(rmse_m(cloud, *decode(*voxel)), 1.02 * rmse_m(cloud, *decode(*draco)));
  EXPECT_EQ(voxel->bytes, again->bytes);
}

TEST_P(CodecSeeds, AThinnedFrameFitsARequest) {  // what a client sends of a frame
  const Cloud cloud = voxel_downsample(room_view(GetParam(), 120'000), 0.05, 4000);
  const auto voxel = encode(cloud, kVoxel), draco = encode(cloud);
  ASSERT_TRUE(voxel && draco);
  EXPECT_GT(cloud.size(), 3'000U);
  EXPECT_LT(voxel->bytes.size(), cloud.size() * 21 / 10);
  EXPECT_LT(draco->bytes.size(), cloud.size() * 26 / 10);
}

// A code that cannot hold the resolution is coarser: 64 steps to a voxel, 65535 to the longest side.
TEST(Codec, WhatIsTooFineForACodeIsCoarser) {
  const Cloud wide{{{-900, 0, 0}, {0.4444F, 1, 2}, {900, 3, 0.1F}}, {}};
  const auto draco = encode(wide, {.resolution_m = 0.003});
  ASSERT_TRUE(draco) << draco.error().message;
  EXPECT_LT(rmse_m(wide, *decode(*draco)), 1800.0 / 65'535);
  const Cloud near{{{0.1F, 0.2F, 0.3F}}, {}};
  const auto voxel = encode(near, {.codec = CloudCodec::voxel, .voxel_size_m = 1});
  ASSERT_TRUE(voxel) << voxel.error().message;
  EXPECT_LT(rmse_m(near, *decode(*voxel)), 1.0 / 64);
}

TEST(Codec, OnePointAndEqualPointsSurvive) {
  for (const auto codec : kAll) {
    const Cloud one{{Eigen::Vector3f(1, -2, 3)}, {}}, three{{3, Eigen::Vector3f(0.5F, 0, 2)}, {}};
    for (const Cloud& cloud : {one, three}) {
      const auto encoded = encode(cloud, {.codec = codec});
      ASSERT_TRUE(encoded) << encoded.error().message;
      const auto decoded = decode(*encoded);
      ASSERT_TRUE(decoded) << decoded.error().message;
      EXPECT_LT(rmse_m(cloud, *decoded), 0.01);
    }
  }
}

TEST(Codec, RefusesCloudsThatCannotTravel) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(encode(Cloud{}));
  EXPECT_FALSE(encode(Cloud{{Eigen::Vector3f(nan, 0, 0)}, {}}));
  EXPECT_FALSE(encode(Cloud{{Eigen::Vector3f(0, 2000, 0)}, {}}));
  EXPECT_FALSE(encode(Cloud{std::vector<Eigen::Vector3f>(kMaxCodecPoints + 1, Eigen::Vector3f::Zero()), {}}));
  const Cloud fine{{Eigen::Vector3f(1, 0, 0)}, {}};
  EXPECT_FALSE(encode(fine, {.codec = CloudCodec::octree, .octree_depth = 13}));
  EXPECT_FALSE(encode(fine, {.voxel_size_m = 0.005}));
  EXPECT_FALSE(encode(fine, {.resolution_m = 0.00005}));
  EXPECT_FALSE(encode(fine, {.codec = static_cast<CloudCodec>(9)}));
}

TEST(Codec, RefusesMorePointsThanAllowedBeforeDecoding) {
  const Cloud cloud = room_view(4);
  for (const auto codec : kAll) {
    auto encoded = encode(cloud, {.codec = codec});
    ASSERT_TRUE(encoded);
    const auto decoded = decode(*encoded, 100);
    ASSERT_FALSE(decoded);
    EXPECT_NE(decoded.error().message.find("must be 1..100"), std::string::npos) << decoded.error().message;
  }
}

TEST(Codec, RefusesAnUnknownCodec) {
  EXPECT_FALSE(decode(EncodedCloud{static_cast<CloudCodec>(9), {1, 2, 3}}));
  for (const auto codec : kAll) EXPECT_FALSE(decode(EncodedCloud{codec, {}}));
}

class Hostile : public testing::TestWithParam<CloudCodec> {};
INSTANTIATE_TEST_SUITE_P(Codecs, Hostile, testing::ValuesIn(kAll));

// 4 000 damaged streams of each codec: refused, or decoded to finite points within bounds; none crashes.
TEST_P(Hostile, DamagedStreamsAreRefusedOrBounded) {
  std::mt19937 random(20'000);
  const auto encoded = encode(room_view(6, 800), {.codec = GetParam()});
  ASSERT_TRUE(encoded);
  int refused = 0;
  for (int i = 0; i < 4'000; ++i) {
    EncodedCloud mutant = *encoded;
    for (unsigned flips = 1 + random() % 8; flips > 0; --flips)
      mutant.bytes[random() % mutant.bytes.size()] = static_cast<std::uint8_t>(random());
    if (random() % 4 == 0) mutant.bytes.resize(random() % mutant.bytes.size());
    const auto decoded = decode(mutant);
    if (!decoded) {
      ++refused;
      continue;
    }
    ASSERT_LE(decoded->size(), kMaxCodecPoints);
    for (const auto& p : decoded->points) ASSERT_LE(p.cwiseAbs().maxCoeff(), kMaxCoordinate_m);
  }
  EXPECT_GT(refused, 1'000);
}

}  // namespace
}  // namespace liloc
