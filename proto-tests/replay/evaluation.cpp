#include "proto-tests/replay/evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>

#include "common/geometry/pose_estimate.hpp"
#include "proto-tests/replay/csv.hpp"
#include "proto-tests/replay/truth.hpp"

namespace liloc::replay {
namespace {

struct PoseError {
  double rot_deg = 0, trans_m = 0;
  [[nodiscard]] bool within(double max_deg, double max_m) const {
    return rot_deg <= max_deg && trans_m <= max_m;
  }
};

PoseError error_of(const Pose& truth, const Pose& pose) {
  return {degrees(angle_between_rad(truth, pose)), distance_m(truth, pose)};
}

std::optional<double> mean(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

template <class Range, class Test>
std::optional<double> share(const Range& range, Test test) {
  if (range.empty()) return std::nullopt;
  return static_cast<double>(std::count_if(range.begin(), range.end(), test)) /
         static_cast<double>(range.size());
}

template <class Field>
std::vector<double> column(const std::vector<PoseError>& errors, Field field) {
  std::vector<double> values;
  values.reserve(errors.size());
  for (const PoseError& e : errors) values.push_back(e.*field);
  return values;
}

Result<std::vector<StampedPose>> poses_in(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return std::vector<StampedPose>{};
  return read_tum(file);
}

TrackScore score_track(const std::vector<StampedPose>& poses, const Truth& truth, std::size_t frames) {
  std::vector<PoseError> errors;
  for (const StampedPose& pose : poses)
    if (const auto i = truth.frame_near(pose.stamp_ns); i >= 0)
      errors.push_back(error_of(truth.pose(static_cast<std::size_t>(i)), pose.T_map_sensor));
  TrackScore score;
  score.coverage = frames == 0 ? 0 : static_cast<double>(errors.size()) / static_cast<double>(frames);
  const auto rot = column(errors, &PoseError::rot_deg), trans = column(errors, &PoseError::trans_m);
  score.mean_rot_deg = mean(rot);
  score.mean_trans_m = mean(trans);
  score.median_rot_deg = percentile(rot, 0.5);
  score.median_trans_m = percentile(trans, 0.5);
  score.frames_over_10deg_03m = share(errors, [](const PoseError& e) { return !e.within(10, 0.3); });
  score.correct = score.mean_rot_deg && *score.mean_rot_deg <= 10 && *score.mean_trans_m <= 0.3;
  return score;
}

std::optional<Pose> pose_in(const Csv& csv, std::size_t row) {
  std::array<double, 7> values{};
  constexpr std::array<std::string_view, 7> kNames{"tx", "ty", "tz", "qx", "qy", "qz", "qw"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const auto value = csv.number(row, kNames[i]);
    if (!value) return std::nullopt;
    values[i] = *value;
  }
  const auto pose =
      valid_pose({values[0], values[1], values[2]}, {values[3], values[4], values[5], values[6]}, "pose");
  if (!pose) return std::nullopt;
  return *pose;
}

std::vector<double> numbers_in(const Csv& csv, std::string_view name) {
  std::vector<double> values;
  for (std::size_t row = 0; row < csv.rows(); ++row)
    if (const auto value = csv.number(row, name); value && std::isfinite(*value)) values.push_back(*value);
  return values;
}

struct Spot {
  double overlap = 0;
  PoseError error;
  bool verified = false;
};

SpotScore score_spots(const Csv& csv, const Recording& recording, const DeviceRecording& device,
                      const Truth& truth) {
  std::vector<Spot> spots;
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const auto stamp_ns = csv.integer(row, "stamp_ns");
    const auto i = stamp_ns ? truth.frame_near(*stamp_ns) : -1;
    if (i < 0) continue;
    const auto frame = static_cast<std::size_t>(i);
    const auto pose = pose_in(csv, row);
    const auto verified = csv.text(row, "verified");
    spots.push_back({overlap_at_truth(recording, device, device.depth[frame], truth.pose(frame)),
                     pose ? error_of(truth.pose(frame), *pose) : PoseError{999, 999},
                     verified == "1" || verified == "true"});
  }
  std::vector<Spot> counted;
  std::copy_if(spots.begin(), spots.end(), std::back_inserter(counted),
               [](const Spot& s) { return s.overlap >= 0.3; });
  SpotScore score;
  score.n = spots.size();
  score.n_overlap = counted.size();
  score.loose = share(counted, [](const Spot& s) { return s.error.within(10, 0.3); });
  score.strict = share(counted, [](const Spot& s) { return s.error.within(3, 0.1); });
  for (const Spot& s : spots) {
    score.verified += s.verified;
    score.verified_wrong += s.verified && !s.error.within(10, 0.3);
  }
  return score;
}

/// Errors of the steps between consecutive frames, and of the whole way from the first to the last.
std::optional<LocalScore> score_local(const Csv& csv, const Truth& truth) {
  struct Row {
    std::ptrdiff_t frame;
    Pose T_odom_sensor;
  };
  std::vector<Row> rows;
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const auto stamp_ns = csv.integer(row, "stamp_ns");
    const auto pose = pose_in(csv, row);
    if (stamp_ns && pose) rows.push_back({truth.frame_near(*stamp_ns), *pose});
  }
  const auto step_error = [&](const Row& a, const Row& b) {
    const Pose& A = truth.pose(static_cast<std::size_t>(a.frame));
    const Pose& B = truth.pose(static_cast<std::size_t>(b.frame));
    return error_of(A.inverse() * B, a.T_odom_sensor.inverse() * b.T_odom_sensor);
  };
  std::vector<PoseError> steps;
  for (std::size_t k = 1; k < rows.size(); ++k)
    if (rows[k - 1].frame >= 0 && rows[k].frame == rows[k - 1].frame + 1)
      steps.push_back(step_error(rows[k - 1], rows[k]));
  std::erase_if(rows, [](const Row& r) { return r.frame < 0; });
  if (rows.empty()) return std::nullopt;

  LocalScore score;
  const PoseError end = step_error(rows.front(), rows.back());
  score.path_m = truth.path_m();
  score.end_pct_of_path = 100 * end.trans_m / std::max(score.path_m, 0.1);
  score.end_rot_deg = end.rot_deg;
  score.pairs = steps.size();
  score.ok_3deg_01m = share(steps, [](const PoseError& e) { return e.within(3, 0.1); });
  score.median_trans_m = percentile(column(steps, &PoseError::trans_m), 0.5);
  score.median_rot_deg = percentile(column(steps, &PoseError::rot_deg), 0.5);
  return score;
}

std::optional<Matrix6d> matrix_in(std::string_view text) {
  Matrix6d matrix;
  std::istringstream numbers{std::string(text)};
  for (int i = 0; i < 36; ++i)
    if (!(numbers >> matrix(i / 6, i % 6))) return std::nullopt;
  return matrix;
}

DoubtScore score_doubt(const Csv& csv, const std::vector<StampedPose>& online, const Truth& truth) {
  std::map<StampNs, Pose> poses;
  for (const StampedPose& pose : online) poses[pose.stamp_ns] = pose.T_map_sensor;
  std::vector<double> nees;
  double beyond = 0, untold = 0;
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    const auto stamp_ns = csv.integer(row, "stamp_ns");
    const auto covariance = matrix_in(csv.text(row, "covariance"));
    const auto i = stamp_ns ? truth.frame_near(*stamp_ns) : -1;
    if (i < 0 || !covariance || !poses.contains(*stamp_ns)) continue;
    const PoseEstimate told{poses[*stamp_ns], *covariance};
    const Pose& T_true = truth.pose(static_cast<std::size_t>(i));
    nees.push_back(squared_mahalanobis(told, {T_true, Matrix6d::Zero()}));
    beyond += nees.back() > kChiSquareLimit;
    untold += !error_of(T_true, told.T_map_sensor).within(10, 0.3) && told.sd_m() <= 0.3 &&
              told.sd_rad() <= radians(10);
  }
  DoubtScore score;
  score.poses = nees.size();
  if (nees.empty()) return score;
  score.nees_mean = mean(nees);
  score.nees_median = percentile(nees, 0.5);
  score.beyond = beyond / static_cast<double>(nees.size());
  score.wrong_untold = untold / static_cast<double>(nees.size());
  return score;
}

}  // namespace

std::optional<double> percentile(std::vector<double> values, double share) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const double position = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const auto above = std::min(below + 1, values.size() - 1);
  return values[below] + (position - static_cast<double>(below)) * (values[above] - values[below]);
}

Result<DeviceScore> evaluate(const Recording& recording, const DeviceRecording& device,
                             const std::filesystem::path& folder) {
  const auto truth = Truth::of(device);
  if (!truth) return tl::unexpected(truth.error());
  const auto online = poses_in(folder / "online.tum"), trajectory = poses_in(folder / "trajectory.tum");
  if (!online) return tl::unexpected(online.error());
  if (!trajectory) return tl::unexpected(trajectory.error());

  DeviceScore score;
  score.id = device.info.id;
  score.frames = device.depth.size();
  score.has_truth = !truth->empty();
  score.online = score_track(*online, *truth, score.frames);
  score.trajectory = score_track(*trajectory, *truth, score.frames);
  if (const auto doubt = Csv::read(folder / "doubt.csv")) score.doubt = score_doubt(*doubt, *online, *truth);
  if (!online->empty() && !device.depth.empty())
    score.first_pose_ms = to_ms(online->front().stamp_ns - device.depth.front().stamp_ns);
  if (!score.has_truth && score.frames > 0) {  // coverage needs no truth
    score.online.coverage = static_cast<double>(online->size()) / static_cast<double>(score.frames);
    score.trajectory.coverage = static_cast<double>(trajectory->size()) / static_cast<double>(score.frames);
  }
  if (const auto spots = Csv::read(folder / "spots.csv")) {
    score.spots = score_spots(*spots, recording, device, *truth);
    if (!score.has_truth) {
      score.spots.n = spots->rows();
      for (std::size_t row = 0; row < spots->rows(); ++row)
        score.spots.verified += spots->text(row, "verified") == "1";
    }
    score.spots.latency_ms_median = percentile(numbers_in(*spots, "latency_ms"), 0.5);
    score.spots.latency_ms_p99 = percentile(numbers_in(*spots, "latency_ms"), 0.99);
    for (std::size_t row = 0; row < spots->rows(); ++row)
      ++score.reasons[std::string(spots->text(row, "reason"))];
  }
  if (const auto local = Csv::read(folder / "local.csv")) {
    score.local = score_local(*local, *truth);
    if (!score.local && local->rows() > 0) score.local = LocalScore{};
    if (score.local) score.local->latency_ms_median = percentile(numbers_in(*local, "latency_ms"), 0.5);
  }
  return score;
}

}  // namespace liloc::replay
