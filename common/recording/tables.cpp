// imu.csv (EuRoC) and *.tum, both ways.
#include <array>
#include <string_view>

#include "common/recording/files.hpp"
#include "common/recording/table_rows.hpp"
#include "common/recording/writer.hpp"

namespace liloc {
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
  std::string text = std::string(kImuHead) + "\n";
  for (const auto& sample : samples) text += imu_row(sample) + "\n";
  return write_file(file, text);
}

Status write_tum(const std::filesystem::path& file, const std::vector<StampedPose>& poses) {
  std::string text = "# timestamp_s tx ty tz qx qy qz qw : T_map_sensor\n";
  for (const auto& pose : poses) {
    const Eigen::Vector3d t = pose.T_map_sensor.translation();
    const Eigen::Quaterniond q = Eigen::Quaterniond(pose.T_map_sensor.linear()).normalized();
    fmt::format_to(std::back_inserter(text), "{} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n",
                   seconds_text(pose.stamp_ns), t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  }
  return write_file(file, text);
}

}  // namespace liloc
