#include "common/recording/imu_table.hpp"

#include <gmock/gmock.h>

#include "common/recording/recording.hpp"
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
  ASSERT_TRUE(table.close());
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
              HasSubstr("imu.csv: cannot be written"));
  ASSERT_TRUE(full.open("/dev/full"));  // which the stream's memory hides until it is emptied
  EXPECT_TRUE(full.add(at(1)));
  EXPECT_THAT(full.close().error().message,
              HasSubstr("/dev/full: cannot be written; check the folder's free space"));
}

}  // namespace
}  // namespace liloc
