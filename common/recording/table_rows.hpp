#pragma once
// Private to the room: rows and cells of tables in text.
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include "common/base/result.hpp"
#include "common/base/stamp.hpp"
#include "common/geometry/camera.hpp"

namespace liloc {

constexpr std::size_t kLargestTableBytes = std::size_t{1} << 30;  // memory bound; by hand

/// Calls `row(line number, line)` for each line that is neither empty nor a comment; stops at the first error.
template <class Row>
Status for_each_row(std::string_view text, Row row) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";  // spreadsheets put it first
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::size_t number = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    ++number;
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    if (line.empty() || line.front() == '#') continue;
    if (Status done = row(number, line); !done) return done;
  }
  return {};
}

/// Cuts the next cell off `line`; cells are parted by commas or blanks.
[[nodiscard]] std::string_view next_cell(std::string_view& line);

template <class T>
bool parse(std::string_view cell, T& value) {
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size();
}

/// Fills `values` with the rest of the line: exactly that many finite numbers.
template <std::size_t N>
bool parse_rest(std::string_view line, std::array<double, N>& values) {
  for (double& value : values)
    if (!parse(next_cell(line), value) || !std::isfinite(value)) return false;
  return next_cell(line).empty();
}

constexpr std::int64_t kNsInSecond = 1'000'000'000;

/// "1700122000.05" to nanoseconds, exactly: a double keeps only 240 ns of an epoch.
[[nodiscard]] bool parse_seconds(std::string_view cell, StampNs& stamp_ns);
/// The reverse, with nine decimals.
[[nodiscard]] std::string seconds_text(StampNs stamp_ns);

constexpr std::string_view kImuHead = "#timestamp_ns,wx_rad_s,wy_rad_s,wz_rad_s,ax_m_s2,ay_m_s2,az_m_s2";
/// One line of imu.csv, without its end.
[[nodiscard]] std::string imu_row(const ImuSample& sample);

}  // namespace liloc
