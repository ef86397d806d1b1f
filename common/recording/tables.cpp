// imu.csv (EuRoC) and *.tum, both ways. Stamps are parsed as integers: a double keeps only 240 ns of an epoch.
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include "common/recording/files.hpp"
#include "common/recording/writer.hpp"

namespace liloc {
namespace {

// Memory bound; by hand.
constexpr std::size_t kLargestTableBytes = std::size_t{1} << 30;
constexpr std::int64_t kNsInSecond = 1'000'000'000;

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
std::string_view next_cell(std::string_view& line) {
  const std::size_t begin = line.find_first_not_of(", \t");
  if (begin == std::string_view::npos) return line = {};
  line.remove_prefix(begin);
  const std::string_view cell = line.substr(0, line.find_first_of(", \t"));
  line.remove_prefix(cell.size());
  return cell;
}

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

/// "1700122000.05" to nanoseconds, exactly.
bool parse_seconds(std::string_view cell, StampNs& stamp_ns) {
  const std::size_t dot = cell.find('.');
  std::int64_t seconds = 0, fraction_ns = 0;
  if (!parse(cell.substr(0, dot), seconds) || seconds < 0 ||
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

}  // namespace

Result<std::vector<ImuSample>> read_imu(const std::filesystem::path& file) {
  const auto text = read_file(file, kLargestTableBytes);
  if (!text) return tl::unexpected(text.error());
  std::vector<ImuSample> samples;
  const Status read = for_each_row(*text, [&](std::size_t number, std::string_view line) -> Status {
    StampNs stamp_ns = 0;
    std::array<double, 6> v{};
    if (!parse(next_cell(line), stamp_ns) || stamp_ns < 0 || !parse_rest(line, v))
      return fail("{}: line {} is not timestamp_ns,wx,wy,wz,ax,ay,az; mend or drop it", file.string(), number);
    if (!samples.empty() && stamp_ns <= samples.back().stamp_ns)
      return fail("{}: line {}: timestamp_ns {} does not rise (before: {}); sort the rows", file.string(),
                  number, stamp_ns, samples.back().stamp_ns);
    samples.push_back({stamp_ns, {v[0], v[1], v[2]}, {v[3], v[4], v[5]}});
    return {};
  });
  if (!read) return tl::unexpected(read.error());
  return samples;
}

Result<std::vector<StampedPose>> read_tum(const std::filesystem::path& file) {
  const auto text = read_file(file, kLargestTableBytes);
  if (!text) return tl::unexpected(text.error());
  std::vector<StampedPose> poses;
  const Status read = for_each_row(*text, [&](std::size_t number, std::string_view line) -> Status {
    StampedPose pose;
    std::array<double, 7> v{};
    if (!parse_seconds(next_cell(line), pose.stamp_ns) || !parse_rest(line, v))
      return fail("{}: line {} is not t tx ty tz qx qy qz qw; mend or drop it", file.string(), number);
    const auto T = valid_pose({v[0], v[1], v[2]}, {v[3], v[4], v[5], v[6]},
                              fmt::format("{}: line {}", file.string(), number));
    if (!T) return tl::unexpected(T.error());
    if (!poses.empty() && pose.stamp_ns <= poses.back().stamp_ns)
      return fail("{}: line {}: t does not rise; sort the rows", file.string(), number);
    pose.T_map_sensor = *T;
    poses.push_back(pose);
    return {};
  });
  if (!read) return tl::unexpected(read.error());
  return poses;
}

Status write_imu(const std::filesystem::path& file, const std::vector<ImuSample>& samples) {
  std::string text = "#timestamp_ns,wx_rad_s,wy_rad_s,wz_rad_s,ax_m_s2,ay_m_s2,az_m_s2\n";
  for (const auto& s : samples) {
    const auto &w = s.angular_velocity_rad_s, &a = s.specific_force_m_s2;
    fmt::format_to(std::back_inserter(text), "{},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f}\n", s.stamp_ns,
                   w.x(), w.y(), w.z(), a.x(), a.y(), a.z());
  }
  return write_file(file, text);
}

Status write_tum(const std::filesystem::path& file, const std::vector<StampedPose>& poses) {
  std::string text = "# timestamp_s tx ty tz qx qy qz qw : T_map_sensor\n";
  for (const auto& pose : poses) {
    const Eigen::Vector3d t = pose.T_map_sensor.translation();
    const Eigen::Quaterniond q = Eigen::Quaterniond(pose.T_map_sensor.linear()).normalized();
    fmt::format_to(std::back_inserter(text), "{}.{:09} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n",
                   pose.stamp_ns / kNsInSecond, pose.stamp_ns % kNsInSecond, t.x(), t.y(), t.z(), q.x(), q.y(),
                   q.z(), q.w());
  }
  return write_file(file, text);
}

}  // namespace liloc
