#include "client/odometry/image_thinning.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

TEST(ImageThinning, LeavesPixelsOutWhereTheyAre) {
  const DepthImage image{7, 4, 2, {10, 11, 12, 13, 20, 21, 22, 23}};
  const DepthImage small = thinned(image, 2);
  EXPECT_EQ(small.stamp_ns, 7);
  EXPECT_EQ(small.width, 2);
  EXPECT_EQ(small.height, 1);
  EXPECT_EQ(small.units, (std::vector<std::uint16_t>{10, 12}));
}

TEST(ImageThinning, ASaturatedPixelIsNoReturnAndNotSpaceSeenEmpty) {
  const DepthImage image{1, 2, 1, {0xFFFF, 1500}};
  EXPECT_EQ(thinned(image, 1).units, (std::vector<std::uint16_t>{0, 1500}));
}

}  // namespace
}  // namespace liloc
