#include "common/base/ids.hpp"

#include <gmock/gmock.h>

namespace liloc {
namespace {

TEST(Ids, AcceptsWhatTopicsPartitionsAndFoldersCanCarry) {
  for (const char* id : {"a", "ceiling0", "robot_7-b", "Z"}) EXPECT_TRUE(valid_id(id, "id")) << id;
  EXPECT_TRUE(valid_id(std::string(63, 'x'), "id"));
}

TEST(Ids, RefusesAndNamesTheField) {
  for (const char* id : {"", "a/b", "..", "a b", "x*", "\n"}) {
    const auto result = valid_id(id, "client id");
    ASSERT_FALSE(result) << id;
    EXPECT_THAT(result.error().message, testing::HasSubstr("client id"));
  }
  EXPECT_FALSE(valid_id(std::string(64, 'x'), "id"));
}

TEST(Ids, AHostileIdIsMaskedInTheError) {
  EXPECT_THAT(valid_id("\x1b[31m", "id").error().message, testing::Not(testing::HasSubstr("\x1b")));
}

}  // namespace
}  // namespace liloc
