#include "common/base/distinct_topics.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

TEST(DistinctTopics, TwoSensorsOfOneTopicAreNamed) {
  EXPECT_TRUE(check_distinct_topics({}));
  EXPECT_TRUE(check_distinct_topics({"robot-1", "robot_2", "Robot-1"}));
  const auto alike = check_distinct_topics({"robot-1", "ceiling0", "robot_1"});
  ASSERT_FALSE(alike);
  EXPECT_EQ(alike.error().message,
            "robot-1 and robot_1 are one in the names of topics, where a hyphen is an underscore; rename one");
  const auto same = check_distinct_topics({"a", "a"});
  ASSERT_FALSE(same);
  EXPECT_EQ(same.error().message, "a: two sensors have this id; rename one");
}

}  // namespace
}  // namespace liloc
