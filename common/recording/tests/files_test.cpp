#include "common/recording/files.hpp"

#include <gmock/gmock.h>

#include "common/recording/tests/file_limit.hpp"
#include "common/recording/tests/temporary_folder.hpp"

namespace liloc {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(Files, BytesOfAnyKindComeBack) {
  const TemporaryFolder folder;
  std::string bytes = "line\r\n";
  for (int i = 0; i < 256; ++i) bytes.push_back(static_cast<char>(i));
  const fs::path file = folder.path() / "new/deep/a.bin";
  ASSERT_TRUE(write_file(file, bytes));
  EXPECT_EQ(*read_file(file, bytes.size()), bytes);
  ASSERT_TRUE(write_file(file, ""));
  EXPECT_EQ(*read_file(file, 0), "");
  EXPECT_EQ(entries(file.parent_path()), 1U) << "nothing hidden is left";
}

TEST(Files, OneByteTooManyIsRefusedAndSoIsWhatIsNoFile) {
  const TemporaryFolder folder;
  const fs::path file = folder.put("a", "12345");
  EXPECT_TRUE(read_file(file, 5));
  EXPECT_THAT(read_file(file, 4).error().message, HasSubstr("a: has 5 bytes, at most 4 are expected"));
  EXPECT_THAT(read_file(folder.path(), 100).error().message, HasSubstr("not a regular file"));
  EXPECT_THAT(read_file(folder.path() / "none", 100).error().message, HasSubstr("no such file"));
  EXPECT_THAT(read_file("/dev/zero", 100).error().message, HasSubstr("not a regular file"));
}

TEST(Files, WhereNoneCanBeWrittenWhatWasThereStays) {
  const TemporaryFolder folder;
  const fs::path file = folder.put("a", "before");
  EXPECT_THAT(write_file(file / "b", "text").error().message, HasSubstr("its folder cannot be made"));
  fs::create_directories(folder.path() / "full/inner");
  EXPECT_THAT(write_file(folder.path() / "full", "text").error().message,
              HasSubstr("check what stands in its place"));
  Status refused;
  {
    const FileLimit full(10);
    refused = write_file(file, "a text of more than ten bytes");
  }
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("a: cannot be written: File too large; check the folder's"));
  EXPECT_EQ(*read_file(file, 100), "before");
  EXPECT_EQ(entries(folder.path()), 2U) << "no part of what failed is left";
}

}  // namespace
}  // namespace liloc
