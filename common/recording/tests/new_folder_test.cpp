#include "common/recording/new_folder.hpp"

#include <gtest/gtest.h>

#include "common/recording/files.hpp"
#include "common/recording/tests/temporary_folder.hpp"

namespace liloc {
namespace {

namespace fs = std::filesystem;

TEST(NewFolder, AppearsWholeOrNotAtAll) {
  const TemporaryFolder temporary;
  const fs::path target = temporary.path() / "new/";
  {
    const auto folder = NewFolder::beside(target);
    ASSERT_TRUE(write_file(folder->path() / "a", "text"));
    EXPECT_FALSE(fs::exists(target));
  }
  EXPECT_TRUE(fs::is_empty(temporary.path())) << "it was not kept";
  auto folder = NewFolder::beside(target);
  ASSERT_TRUE(write_file(folder->path() / "a", "text"));
  ASSERT_TRUE(folder->keep());
  EXPECT_TRUE(fs::exists(target / "a"));
  EXPECT_FALSE(NewFolder::beside(target));
  EXPECT_TRUE(fs::exists(target / "a"));
}

TEST(NewFolder, WhatAKilledOneLeftIsTakenAwayAndAFullFolderIsNot) {
  const TemporaryFolder temporary;
  temporary.put(".rec.part/old", "of one that was killed");
  auto folder = NewFolder::beside(temporary.path() / "rec");
  ASSERT_TRUE(folder);
  EXPECT_FALSE(fs::exists(folder->path() / "old"));
  ASSERT_TRUE(write_file(folder->path() / "a", "text"));
  temporary.put("rec/theirs", "came in between");
  EXPECT_FALSE(folder->keep());
  EXPECT_TRUE(fs::exists(temporary.path() / "rec/theirs"));
}

TEST(NewFolder, WhereNothingCanBeMadeItSaysSoAtOnce) {
  const TemporaryFolder temporary;
  temporary.put("file", "no folder");
  const auto folder = NewFolder::beside(temporary.path() / "file/rec");
  ASSERT_FALSE(folder);
  EXPECT_NE(folder.error().message.find("file/rec: cannot be made"), std::string::npos)
      << folder.error().message;
}

TEST(NewFolder, WhatWasMadeAboveItGoesWithIt) {
  const TemporaryFolder temporary;
  {
    const auto folder = NewFolder::beside(temporary.path() / "a/b/rec");
    ASSERT_TRUE(folder);
    EXPECT_TRUE(fs::is_directory(folder->path()));
    ASSERT_TRUE(write_file(temporary.path() / "a/theirs", "came in between"));
  }
  EXPECT_TRUE(fs::exists(temporary.path() / "a/theirs"));
  EXPECT_FALSE(fs::exists(temporary.path() / "a/b"));
}

TEST(NewFolder, MovedOnTheFirstKeepsNothingFromTheSecond) {
  const TemporaryFolder temporary;
  auto first = NewFolder::beside(temporary.path() / "rec");
  ASSERT_TRUE(write_file(first->path() / "a", "text"));
  {
    NewFolder second = std::move(*first);
    ASSERT_TRUE(second.keep());
  }
  EXPECT_TRUE(fs::exists(temporary.path() / "rec/a"));
}

}  // namespace
}  // namespace liloc
