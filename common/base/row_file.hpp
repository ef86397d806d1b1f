#pragma once
#include <filesystem>
#include <string_view>

#include "common/base/result.hpp"

namespace liloc {

/// A file of lines that is whole whenever a write fails: rows are on disk, or not there at all. Not
/// thread-safe.
class RowFile {
 public:
  RowFile() = default;
  ~RowFile();
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;

  /// Starts the file anew with a first line. Errors: it cannot be made or written.
  [[nodiscard]] Status open(const std::filesystem::path& path, std::string_view header);
  /// A line, without its end. After the first error nothing more is written, and the error stays.
  [[nodiscard]] Status append(std::string_view row);

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::int64_t size_ = 0;  ///< of the whole rows, bytes
  Status status_;
};

}  // namespace liloc
