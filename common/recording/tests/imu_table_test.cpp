#include "common/recording/imu_table.hpp"

#include <gmock/gmock.h>

#include "common/recording/recording.hpp"
#include "common/recording/tests/file_limit.hpp"
#include "common/recording/tests/temporary_folder.hpp"

namespace liloc {
namespace {

using testing::HasSubstr;

ImuSample at(StampNs stamp_ns) {
  return {stamp_ns, {0.1, -0.2, 0.3}, {0.01, 0.02, 9.81}};
}

TEST(ImuTable, LeavesOutWhatDoesNotRiseSoThatReadersTakeIt) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "new" / "imu.csv";
  ImuTable table;
  ASSERT_TRUE(table.open(file));
  EXPECT_TRUE(table.add(at(5)));
  EXPECT_FALSE(table.add(at(5)));
  EXPECT_FALSE(table.add(at(4)));
  EXPECT_TRUE(table.add(at(6)));
  EXPECT_EQ(table.rows(), 2U);
  EXPECT_TRUE(table.written());
  const auto read = read_imu(file);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 2U);
  EXPECT_EQ(read->back().stamp_ns, 6);
  EXPECT_EQ(read->back().angular_velocity_rad_s, at(6).angular_velocity_rad_s);
}

TEST(ImuTable, WhereItCannotBeMadeOrWrittenIsTold) {
  const TemporaryFolder folder;
  ImuTable nowhere, full;
  EXPECT_THAT(nowhere.open(folder.put("a", "") / "imu.csv").error().message,
              HasSubstr("imu.csv: Not a directory: check the folder's permissions and space"));
  EXPECT_THAT(full.open("/dev/full").error().message, HasSubstr("/dev/full: No space left on device"));
}

TEST(ImuTable, ASampleThatDoesNotFitLeavesWholeRows) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "imu.csv";
  ImuTable table;
  ASSERT_TRUE(table.open(file));
  ASSERT_TRUE(table.add(at(1)));
  {
    const FileLimit full(std::filesystem::file_size(file) + 20);  // half a row more
    EXPECT_FALSE(table.add(at(2)));
  }
  EXPECT_FALSE(table.add(at(3))) << "or one would be missing in between";
  EXPECT_EQ(table.rows(), 1U);
  ASSERT_FALSE(table.written());
  EXPECT_THAT(table.written().error().message, HasSubstr("imu.csv: File too large: nothing more is written"));
  const auto read = read_imu(file);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->size(), 1U);
}

}  // namespace
}  // namespace liloc
