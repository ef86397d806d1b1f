#include "common/base/ros_name.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

TEST(RosName, HasNoHyphens) {
  EXPECT_EQ(ros_name("robot-7_b"), "robot_7_b");
  EXPECT_EQ(ros_name("ceiling0"), "ceiling0");
}

}  // namespace
}  // namespace liloc
