#include "common/recording/imu_table.hpp"

#include <system_error>

#include "common/recording/table_rows.hpp"

namespace liloc {

Status ImuTable::open(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  written_ = file_.open(file, kImuHead);
  return written_;
}

bool ImuTable::add(const ImuSample& sample) {
  if (sample.stamp_ns <= last_ns_) return false;
  written_ = file_.append(imu_row(sample));
  if (!written_) return false;
  last_ns_ = sample.stamp_ns;
  ++rows_;
  return true;
}

}  // namespace liloc
