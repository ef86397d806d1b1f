#pragma once
// imu.csv, row by row as samples come; each is on disk before the next one. Not thread-safe.
#include <filesystem>

#include "common/base/row_file.hpp"
#include "common/geometry/camera.hpp"

namespace liloc {

class ImuTable {
 public:
  /// Makes the folder if need be. Error: the file cannot be made.
  [[nodiscard]] Status open(const std::filesystem::path& file);
  /// Whether it was taken: one whose stamp does not rise is left out, since readers refuse it, and so is what
  /// cannot be written.
  bool add(const ImuSample& sample);
  [[nodiscard]] std::size_t rows() const { return rows_; }
  /// Error: a row could not be written, e.g. as the disk was full; those before it are whole.
  [[nodiscard]] const Status& written() const { return written_; }

 private:
  RowFile file_;
  Status written_;
  StampNs last_ns_ = -1;
  std::size_t rows_ = 0;
};

}  // namespace liloc
