#include "client/odometry/local_method.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

TEST(LocalMethod, HasTheNamesOfTheCommandLine) {
  EXPECT_EQ(*local_method_from("cloud"), LocalMethod::cloud);
  EXPECT_EQ(*local_method_from("inertial"), LocalMethod::inertial);
  EXPECT_EQ(*local_method_from("dead-reckoning"), LocalMethod::dead_reckoning);
  EXPECT_EQ(*local_method_from("external"), LocalMethod::external);
}

TEST(LocalMethod, AWrongNameIsToldWhichThereAre) {
  const auto magic = local_method_from("magic");
  ASSERT_FALSE(magic);
  EXPECT_EQ(magic.error().message,
            "local method is 'magic'; must be cloud, inertial, dead-reckoning or external");
  EXPECT_FALSE(local_method_from(""));
  EXPECT_FALSE(local_method_from("Cloud"));
}

}  // namespace
}  // namespace liloc
