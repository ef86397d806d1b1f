#include "common/codec/octree.hpp"

#include <gtest/gtest.h>

#include "common/codec/tests/room_view.hpp"

namespace liloc {
namespace {

class OctreeSeeds : public testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Seeds, OctreeSeeds, testing::Range(1U, 4U));

float longest_side_m(const Cloud& cloud) {
  Eigen::AlignedBox3f box;
  for (const auto& p : cloud.points) box.extend(p);
  return box.sizes().maxCoeff();
}

TEST_P(OctreeSeeds, OctreeErrsByHalfALeaf) {
  const Cloud cloud = room_view(GetParam());
  for (const int depth : {8, 10}) {
    const auto encoded = encode(cloud, {.codec = CloudCodec::octree, .octree_depth = depth});
    ASSERT_TRUE(encoded) << encoded.error().message;
    const auto decoded = decode(*encoded);
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_LT(rmse_m(cloud, *decoded), 0.53 * longest_side_m(cloud) / (1 << depth)) << depth;
  }
}

}  // namespace
}  // namespace liloc
