// Bags that no writer makes: lengths that are not so, bombs, endless views.
#include <gmock/gmock.h>
#include <sqlite3.h>
#include <zstd.h>

#include <limits>

#include "common/recording/bags/bag.hpp"
#include "common/recording/bags/limits.hpp"
#include "common/recording/bags/ros_messages.hpp"
#include "common/recording/bags/tests/written.hpp"
#include "common/recording/tests/temporary_folder.hpp"

namespace liloc::bags {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class HostileBag : public testing::Test {
 protected:
  /// What is wrong with an MCAP file of these records; empty: it was read.
  std::string error_of(const std::string& records) {
    messages_ = 0;
    const Status read =
        read_bag(folder_.put("bag.mcap", written::mcap(records)), [&](const Message&) -> Status {
          ++messages_;
          return {};
        });
    return read ? "" : read.error().message;
  }
  /// The same of a database that these statements make.
  std::string error_of_sql(const std::string& statements) {
    const fs::path file = folder_.path() / "bag.db3";
    fs::remove(file);
    sqlite3* database = nullptr;
    EXPECT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, statements.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database);
    sqlite3_close(database);
    const Status read = read_bag(file, [](const Message&) { return Status(); });
    return read ? "" : read.error().message;
  }

  const TemporaryFolder folder_;
  std::size_t messages_ = 0;
};

TEST_F(HostileBag, AChunkThatSaysAGigabyteIsRefusedBeforeItIsMade) {
  for (const char* how : {"", "zstd", "lz4"})
    EXPECT_THAT(error_of(written::chunk(how, "tiny", std::uint64_t{1} << 30)), HasSubstr("at most 268435456"));
  EXPECT_THAT(error_of(written::chunk("zstd", "", std::numeric_limits<std::uint64_t>::max())),
              HasSubstr("at most"));
}

TEST_F(HostileBag, AChunkThatUnpacksToMoreThanItSaysIsRefused) {
  const std::string zeros(64 << 20, '\0');
  std::string bomb(ZSTD_compressBound(zeros.size()), '\0');
  bomb.resize(ZSTD_compress(bomb.data(), bomb.size(), zeros.data(), zeros.size(), 1));
  ASSERT_LT(bomb.size(), 16384U);
  EXPECT_THAT(error_of(written::chunk("zstd", bomb, 100)), HasSubstr("damaged zstd chunk"));
  EXPECT_THAT(error_of(written::chunk("zstd", bomb, zeros.size() + 1)), HasSubstr("another size"));
}

TEST_F(HostileBag, LengthsBeyondTheRecordAreDamage) {
  EXPECT_THAT(error_of(written::record(4, "\1\1\1\1\xff\xff\xff\x7f")), HasSubstr("damaged record (kind 4)"));
  EXPECT_THAT(error_of(written::record(3, std::string("\1\0", 2) + written::text(std::string(5000, 'x')))),
              HasSubstr("damaged record (kind 3)"));
  EXPECT_THAT(error_of(written::chunk("", "\5\xff\xff\xff\xff\xff\xff\xff\xff", 9)),
              HasSubstr("damaged chunk"));
  const std::string inner = written::chunk("", "", 0);
  EXPECT_THAT(error_of(written::chunk("", inner, inner.size())), HasSubstr("chunk in a chunk"));
  EXPECT_THAT(error_of(written::chunk("brotli", "x", 1)), HasSubstr("'brotli'; zstd and lz4"));
  EXPECT_THAT(error_of(written::message("")), HasSubstr("channel that it does not describe"));
}

TEST_F(HostileBag, WhatIsNotWantedIsPassedOver) {
  constexpr std::uint8_t kAttachment = 9, kUnknown = 200;
  EXPECT_EQ(error_of(written::channel("/a", "std_msgs/msg/String") + written::record(kAttachment, "photo") +
                     written::record(kUnknown, "") + written::message("hello")),
            "");
  EXPECT_EQ(messages_, 1U);
}

TEST_F(HostileBag, AViewWhichMayNeverEndIsNotAsked) {
  EXPECT_THAT(error_of_sql("CREATE TABLE topics(id INTEGER PRIMARY KEY, name, type, serialization_format);"
                           "INSERT INTO topics VALUES(1, '/a', 't', 'cdr');"
                           "CREATE VIEW messages AS SELECT 1 AS id, 1 AS topic_id, '' AS data;"),
              HasSubstr("view \"messages\" prohibited"));
}

TEST_F(HostileBag, ADatabaseOfAnythingElseIsNamed) {
  EXPECT_THAT(error_of_sql("CREATE TABLE songs(id);"), HasSubstr("no such table: topics"));
  const std::string tables =
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name, type, serialization_format);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, data);";
  EXPECT_EQ(error_of_sql(tables), "");
  EXPECT_THAT(error_of_sql(tables + "INSERT INTO messages VALUES(1, 7, 0, x'00');"), HasSubstr("of no topic"));
  const std::string topic = tables + "INSERT INTO topics VALUES(7, '/a', 't', 'cdr');";
  EXPECT_THAT(error_of_sql(topic + "INSERT INTO messages VALUES(1, 7, 0, x'28b52ffd00');"),
              HasSubstr("compressed one by one"));
  EXPECT_THAT(error_of_sql(tables + "INSERT INTO topics VALUES(7, '/a', 't', 'json');"
                                    "INSERT INTO messages VALUES(1, 7, 0, x'00');"),
              HasSubstr("serialized as 'json'"));
}

TEST(HostileMessage, ImagesWhoseSizesDoNotGoTogether) {
  constexpr std::uint32_t kHuge = 4'000'000'000;
  EXPECT_TRUE(depth_image(written::image("16UC1", 2, 1, "abcd"), 0.001));
  EXPECT_THAT(depth_image(written::image("16UC1", 2, 2, "abcd"), 0.001).error().message,
              HasSubstr("go together"));
  EXPECT_THAT(depth_image(written::image("16UC1", kHuge, kHuge, "abcd"), 0.001).error().message,
              HasSubstr("is 4000000000x4000000000; an image has 1 to 8192"));
  EXPECT_THAT(depth_image(written::image("32FC1", 60'000, 60'000, "abcd"), 0.001).error().message,
              HasSubstr("is 60000x60000; an image has 1 to 8192"));
  EXPECT_THAT(depth_image(written::image("16UC1", 8192, 8192, "abcd"), 0.001).error().message,
              HasSubstr("go together"))
      << "before room is made for it";
  EXPECT_THAT(depth_image(written::image("rgb8", 1, 1, "abc"), 0.001).error().message, HasSubstr("'rgb8'"));
  EXPECT_FALSE(depth_image("", 0.001));
}

TEST(HostileMessage, MetresBecomeUnitsOfTheSensor) {
  const std::string data = written::number(1.5F) + written::number(-1.F) +
                           written::number(std::numeric_limits<float>::quiet_NaN()) + written::number(1e9F);
  EXPECT_THAT(depth_image(written::image("32FC1", 4, 1, data), 0.00025)->value.units,
              testing::ElementsAre(6000, 0, 0, 0));
}

TEST(HostileMessage, CloudsWhoseSizesDoNotGoTogether) {
  const auto cloud = [](std::uint32_t height, std::uint32_t width, std::uint32_t row_step) {
    written::Cdr out;
    out.header("lidar").put(height).put(width).put(std::uint32_t{3});
    for (const char* axis : {"x", "y", "z"})
      out.text(axis).put(std::uint32_t{0}).put(std::uint8_t{7}).put(std::uint32_t{1});
    out.put(std::uint8_t{0}).put(std::uint32_t{12}).put(row_step).blob(std::string(12, '\0'));
    return out.put(std::uint8_t{1}).done();
  };
  constexpr std::uint32_t kHuge = 4'000'000'000;
  EXPECT_EQ(point_cloud(cloud(1, 1, 12))->value.points.size(), 1U);
  EXPECT_EQ(point_cloud(cloud(kHuge, 0, 0))->value.points.size(), 0U);
  EXPECT_FALSE(point_cloud(cloud(kHuge, 1, 0)));
  EXPECT_FALSE(point_cloud(cloud(kHuge, 1, 12)));
  EXPECT_FALSE(point_cloud(cloud(1, kHuge, 12)));
}

}  // namespace
}  // namespace liloc::bags
