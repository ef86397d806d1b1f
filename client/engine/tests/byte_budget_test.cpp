#include "client/engine/byte_budget.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "common/geometry/depth.hpp"
#include "common/geometry/voxel.hpp"
#include "common/testing/walk.hpp"

namespace liloc {
namespace {

using namespace test;

TEST(EncodeWithin, TakesAsManyPointsAsFit) {
  const Cloud cloud = *depth_to_cloud(frame_at(scene::furnished_room(1), 0), scene::small_camera());
  const auto thinned = [&](std::size_t most) { return voxel_downsample(cloud, 0.05, most); };
  const auto whole = encode_within(60'000, 4000, {}, thinned);
  ASSERT_TRUE(whole);
  for (const std::size_t budget : {200UL, 1000UL, 2000UL, 3000UL}) {
    ASSERT_LT(budget, whole->bytes.size());
    const auto within = encode_within(budget, 4000, {}, thinned);
    ASSERT_TRUE(within) << within.error().message;
    EXPECT_LE(within->bytes.size(), budget);
    EXPECT_GT(within->bytes.size(), budget / 3) << "of " << budget;  // blocks give way as a whole
  }
  EXPECT_FALSE(encode_within(10, 4000, {}, thinned));
}

/// Distance from each point to the nearest of the others, root mean square.
double rms_to(const Cloud& points, const Cloud& others) {
  double squares = 0;
  for (const Eigen::Vector3f& p : points.points) {
    float nearest = std::numeric_limits<float>::max();
    for (const Eigen::Vector3f& o : others.points) nearest = std::min(nearest, (p - o).squaredNorm());
    squares += static_cast<double>(nearest);
  }
  return std::sqrt(squares / static_cast<double>(points.size()));
}

TEST(EncodeWithin, FiveKeyframesTake15KilobytesAtOneAndAHalfMillimetres) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const auto room = scene::furnished_room(seed);
    Cloud keyframes;
    for (int i = 0; i < 100; i += 20) {
      const Cloud seen = *depth_to_cloud(frame_at(room, i), scene::small_camera());
      for (const Eigen::Vector3f& p : seen.points)
        keyframes.points.push_back(walk(time_of(i)).cast<float>() * p);
    }
    const auto thinned = [&](std::size_t most) { return voxel_downsample(keyframes, 0.05, most); };
    for (const auto& [codec, fewest] : {std::pair{CloudCodec::draco, 7000U}, {CloudCodec::voxel, 8000U}}) {
      const auto code = encode_within(15'000, kMaxCodecPoints, {.codec = codec}, thinned);
      ASSERT_TRUE(code) << code.error().message;
      EXPECT_EQ(code->codec, codec);
      EXPECT_LE(code->bytes.size(), 15'000U);
      const auto decoded = decode(*code);
      ASSERT_TRUE(decoded);
      EXPECT_GT(decoded->size(), fewest) << name_of(codec) << ", seed " << seed;
      EXPECT_LT(rms_to(*decoded, thinned(decoded->size())), 0.00152) << name_of(codec) << ", seed " << seed;
    }
  }
}

}  // namespace
}  // namespace liloc
