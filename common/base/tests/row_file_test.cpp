#include "common/base/row_file.hpp"

#include <gmock/gmock.h>

#include "common/recording/files.hpp"
#include "common/recording/tests/file_limit.hpp"
#include "common/recording/tests/temporary_folder.hpp"

namespace liloc {
namespace {

using testing::HasSubstr;

TEST(RowFile, StartsAnewWithItsHeader) {
  const TemporaryFolder folder;
  const auto path = folder.put("a.csv", "of an earlier run\nand more\n");
  RowFile file;
  ASSERT_TRUE(file.open(path, "#x,y"));
  ASSERT_TRUE(file.append("1,2"));
  ASSERT_TRUE(file.append("3,4"));
  EXPECT_EQ(*read_file(path, 100), "#x,y\n1,2\n3,4\n") << "each row is there at once";
}

TEST(RowFile, ARowThatDoesNotFitIsNotThereAtAllAndNorIsAnyLater) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.csv";
  RowFile file;
  ASSERT_TRUE(file.open(path, "#x"));
  ASSERT_TRUE(file.append("whole"));
  {
    const FileLimit full(12);  // of a row of nine bytes three would still fit
    const Status refused = file.append("too long");
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().message, HasSubstr("a.csv: File too large: nothing more is written"));
  }
  EXPECT_FALSE(file.append("fits")) << "the error stays, or a row would be missing in between";
  EXPECT_EQ(*read_file(path, 100), "#x\nwhole\n");
}

TEST(RowFile, WhereNoneCanBeMadeTheErrorNamesIt) {
  const TemporaryFolder folder;
  RowFile file;
  const Status none = file.open(folder.path() / "absent" / "a.csv", "#x");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("absent/a.csv: No such file or directory: check the folder"));
}

}  // namespace
}  // namespace liloc
