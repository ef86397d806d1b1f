#include "client/odometry/pose_source.hpp"

#include <gtest/gtest.h>

#include <set>

namespace liloc {
namespace {

TEST(PoseSource, EachHasANameOfItsOwn) {
  std::set<std::string_view> names;
  for (int i = 0; i <= static_cast<int>(PoseSource::external); ++i)
    names.insert(name_of(static_cast<PoseSource>(i)));
  EXPECT_EQ(names.size(), 7U);
  EXPECT_FALSE(names.contains("unknown"));
  EXPECT_EQ(name_of(PoseSource::ransac), "ransac") << "as tables of earlier runs have it";
  EXPECT_EQ(name_of(static_cast<PoseSource>(99)), "unknown");
}

}  // namespace
}  // namespace liloc
