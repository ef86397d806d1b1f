#include "common/recording/imu_table.hpp"

#include <system_error>

#include "common/recording/table_rows.hpp"

namespace liloc {

Status ImuTable::open(const std::filesystem::path& file) {
  file_ = file;
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  out_.open(file, std::ios::binary | std::ios::trunc);
  out_ << kImuHead;
  if (!out_) return fail("{}: cannot be written; check the folder's permissions and free space", file.string());
  return {};
}

bool ImuTable::add(const ImuSample& sample) {
  if (sample.stamp_ns <= last_ns_) return false;
  last_ns_ = sample.stamp_ns;
  ++rows_;
  out_ << imu_row(sample) << std::flush;  // a killed recorder leaves whole rows
  return true;
}

Status ImuTable::close() {
  out_.close();
  if (!out_) return fail("{}: cannot be written; check the folder's free space", file_.string());
  return {};
}

}  // namespace liloc
