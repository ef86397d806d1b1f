#include "client/inertial/imu_range.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

TEST(ImuRange, AValueThatStaysAtExactlyALargeOneIsTheEnd) {
  EXPECT_TRUE(rate_clips({0, -4.36, 0}, {0.1, -4.36, 0.2}));
  EXPECT_FALSE(rate_clips({0, -4.36, 0}, {0.1, -4.37, 0.2}));
  EXPECT_FALSE(rate_clips({0, -2.9, 0}, {0, -2.9, 0})) << "a device on a turntable";
  EXPECT_TRUE(force_clips({19.6, 0, 0}, {19.6, 1, 1}));
  EXPECT_FALSE(force_clips({9.81, 0, 0}, {9.81, 0, 0}));
}

}  // namespace
}  // namespace liloc
