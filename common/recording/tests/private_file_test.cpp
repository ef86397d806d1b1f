#include "common/recording/private_file.hpp"

#include <gmock/gmock.h>

#include "common/recording/files.hpp"
#include "common/recording/tests/temporary_folder.hpp"

namespace liloc {
namespace {

namespace fs = std::filesystem;
constexpr fs::perms kOwners = fs::perms::owner_read | fs::perms::owner_write;

TEST(PrivateFile, IsReadByItsOwnerAlone) {
  const TemporaryFolder folder;
  const fs::path file = folder.put("a", "before, for all");
  folder.put(".a.part", "of a program that was killed");
  ASSERT_TRUE(write_private_file(file, "secret"));
  EXPECT_EQ(fs::status(file).permissions(), kOwners);
  EXPECT_EQ(*read_file(file, 100), "secret");
  EXPECT_FALSE(fs::exists(folder.path() / ".a.part"));
  ASSERT_TRUE(write_private_file(folder.path() / "new/deep/b", "secret"));
  EXPECT_EQ(fs::status(folder.path() / "new/deep/b").permissions(), kOwners);
}

TEST(PrivateFile, TroubleIsNamed) {
  const TemporaryFolder folder;
  const fs::path file = folder.put("a", "before");
  EXPECT_THAT(write_private_file(file / "b", "text").error().message, testing::HasSubstr("cannot be"));
  fs::create_directories(folder.path() / "full/inner");
  EXPECT_THAT(write_private_file(folder.path() / "full", "text").error().message,
              testing::HasSubstr("check what stands in its place"));
}

}  // namespace
}  // namespace liloc
