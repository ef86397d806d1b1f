#include "common/recording/table_rows.hpp"

#include <limits>
#include <string>

namespace liloc {

std::string_view next_cell(std::string_view& line) {
  const std::size_t begin = line.find_first_not_of(", \t");
  if (begin == std::string_view::npos) return line = {};
  line.remove_prefix(begin);
  const std::string_view cell = line.substr(0, line.find_first_of(", \t"));
  line.remove_prefix(cell.size());
  return cell;
}

bool parse_seconds(std::string_view cell, StampNs& stamp_ns) {
  const std::size_t dot = cell.find('.');
  std::int64_t seconds = 0, fraction_ns = 0;
  if (cell.starts_with('-') || !parse(cell.substr(0, dot), seconds) ||
      seconds > std::numeric_limits<std::int64_t>::max() / kNsInSecond - 1)
    return false;
  if (dot != std::string_view::npos && dot + 1 < cell.size()) {
    std::string digits(cell.substr(dot + 1, 9));
    if (digits.find_first_not_of("0123456789") != std::string::npos) return false;
    digits.resize(9, '0');
    if (!parse(std::string_view(digits), fraction_ns)) return false;
  }
  stamp_ns = seconds * kNsInSecond + fraction_ns;
  return true;
}

std::string seconds_text(StampNs stamp_ns) {
  return fmt::format("{}.{:09}", stamp_ns / kNsInSecond, stamp_ns % kNsInSecond);
}

std::string imu_row(const ImuSample& sample) {
  const auto &w = sample.angular_velocity_rad_s, &a = sample.specific_force_m_s2;
  return fmt::format("{},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f}", sample.stamp_ns, w.x(), w.y(), w.z(),
                     a.x(), a.y(), a.z());
}

}  // namespace liloc
