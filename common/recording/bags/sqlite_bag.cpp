// rosbag2 in SQLite: two tables, read as tables alone. A database can hold views and functions that run for
// ever, so that none of its schema is trusted.
#include <sqlite3.h>

#include <array>
#include <fstream>
#include <map>
#include <memory>
#include <string>

#include "common/recording/bags/bag.hpp"
#include "common/recording/bags/limits.hpp"

namespace liloc::bags {
namespace {

using Database = std::unique_ptr<sqlite3, decltype(&sqlite3_close)>;
using Statement = std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)>;

struct Topic {
  std::string name, type, format;
};

std::string_view bytes_of(sqlite3_stmt* row, int column) {
  const auto* bytes = static_cast<const char*>(sqlite3_column_blob(row, column));
  return bytes == nullptr
             ? std::string_view()
             : std::string_view(bytes, static_cast<std::size_t>(sqlite3_column_bytes(row, column)));
}

/// SQLite takes what a last page lacks for zeros: its head says how large the file has to be.
Status check_size(const std::filesystem::path& file) {
  constexpr std::size_t kHead = 100, kPageSize = 16, kPages = 28;
  std::array<unsigned char, kHead> head{};
  std::ifstream in(file, std::ios::binary);
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || !in.read(reinterpret_cast<char*>(head.data()), kHead)) return fail("the file ends in its head");
  const auto byte = [&](std::size_t at) { return std::uintmax_t{head[at]}; };
  const std::uintmax_t written = byte(kPageSize) << 8U | byte(kPageSize + 1),
                       page = written == 1 ? 65536 : written;
  const std::uintmax_t pages =
      byte(kPages) << 24U | byte(kPages + 1) << 16U | byte(kPages + 2) << 8U | byte(kPages + 3);
  if (size < page * pages) return fail("the file has {} of {} bytes", size, page * pages);
  return {};
}

/// One bag. Every error of SQLite is told with the bag's name and the remedy.
class SqliteBag {
 public:
  explicit SqliteBag(const std::filesystem::path& file) : name_(file.string()) {
    sqlite3* raw = nullptr;
    opened_ = sqlite3_open_v2(name_.c_str(), &raw, SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX, nullptr);
    database_.reset(raw);
    if (opened_ != SQLITE_OK) return;
    sqlite3_limit(raw, SQLITE_LIMIT_LENGTH, static_cast<int>(kLargestChunk));
    sqlite3_db_config(raw, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_db_config(raw, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  }

  Status read(const OnMessage& on_message) {
    if (opened_ != SQLITE_OK) return wrong(sqlite3_errmsg(database_.get()));
    if (const Status whole = check_size(name_); !whole) return wrong(whole.error().message);
    const Status topics = each("SELECT id, name, type, serialization_format FROM topics",
                               [&](sqlite3_stmt* row) { return note_topic(row); });
    if (!topics) return topics;
    return each("SELECT topic_id, data FROM messages ORDER BY id",
                [&](sqlite3_stmt* row) { return hand_out(row, on_message); });
  }

 private:
  [[nodiscard]] Status wrong(std::string_view why) const {
    return fail("{}: is no sound rosbag2 database ({}); record it anew, or run ros2 bag reindex", name_, why);
  }

  template <class OnRow>
  Status each(const char* query, OnRow on_row) {
    sqlite3_stmt* prepared = nullptr;
    const int ready = sqlite3_prepare_v2(database_.get(), query, -1, &prepared, nullptr);
    const Statement rows(prepared, &sqlite3_finalize);
    if (ready != SQLITE_OK) return wrong(sqlite3_errmsg(database_.get()));
    int step = SQLITE_ROW;
    while ((step = sqlite3_step(rows.get())) == SQLITE_ROW)
      if (Status done = on_row(rows.get()); !done) return done;
    return step == SQLITE_DONE ? Status() : wrong(sqlite3_errmsg(database_.get()));
  }

  Status note_topic(sqlite3_stmt* row) {
    if (topics_.size() >= kMostTopics) return wrong("it has too many topics");
    for (const int column : {1, 2, 3})
      if (bytes_of(row, column).size() > kLongestName) return wrong("a topic's name or type is too long");
    topics_[sqlite3_column_int64(row, 0)] = {std::string(bytes_of(row, 1)), std::string(bytes_of(row, 2)),
                                             std::string(bytes_of(row, 3))};
    return {};
  }

  Status hand_out(sqlite3_stmt* row, const OnMessage& on_message) const {
    const auto topic = topics_.find(sqlite3_column_int64(row, 0));
    if (topic == topics_.end()) return wrong("a message is of no topic");
    if (topic->second.format != "cdr")
      return fail("{}: {} is serialized as '{}'; give a bag in cdr", name_, topic->second.name,
                  topic->second.format);
    const std::string_view cdr = bytes_of(row, 1);
    constexpr std::string_view kZstd = "\x28\xb5\x2f\xfd";
    if (cdr.starts_with(kZstd))
      return fail("{}: its messages are compressed one by one; unpack it with ros2 bag convert", name_);
    return on_message({topic->second.name, topic->second.type, cdr});
  }

  std::string name_;
  Database database_{nullptr, &sqlite3_close};
  int opened_ = SQLITE_ERROR;
  std::map<sqlite3_int64, Topic> topics_;
};

}  // namespace

Status read_sqlite(const std::filesystem::path& file, const OnMessage& on_message) {
  return SqliteBag(file).read(on_message);
}

}  // namespace liloc::bags
