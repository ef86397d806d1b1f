#include "common/registration/spot/judge.hpp"

#include <algorithm>
#include <array>

namespace liloc {
namespace {

constexpr std::size_t kAtOnce = 512;  // points that are looked at together

struct Counts {
  int agree = 0, conflict = 0;
};

Counts near_bare_target(const Target& target, const Cloud& points, const Eigen::Isometry3f& T) {
  Counts counts;
  for (const Eigen::Vector3f& point : points.points)
    counts.agree += target->nearest.nearest(T * point) != NearestGrid::kNone;
  return counts;
}

/// The word of all ceiling views on the device's points. Beside somebody who moves, looking by says nothing.
Counts device_against_ceiling(const Target& target, const Cloud& points, const Eigen::Isometry3f& T,
                              float tolerance) {
  Counts counts;
  std::array<float, kAtOnce> x, y, z, nx, ny, nz;
  std::array<std::int32_t, kAtOnce> words;
  const bool normals = points.has_normals();
  for (std::size_t begin = 0; begin < points.size(); begin += kAtOnce) {
    const std::size_t here = std::min(kAtOnce, points.size() - begin);
    for (std::size_t i = 0; i < here; ++i) {
      const Eigen::Vector3f p = T * points.points[begin + i];
      const Eigen::Vector3f n =
          normals ? Eigen::Vector3f(T.linear() * points.normals[begin + i]) : Eigen::Vector3f::Zero();
      x[i] = p.x(), y[i] = p.y(), z[i] = p.z();
      nx[i] = n.x(), ny[i] = n.y(), nz[i] = n.z();
    }
    std::fill_n(words.begin(), here, kNoWord);
    for (const SightView& view : target.views)
      view.look_at_all({x.data(), y.data(), z.data(), here}, {nx.data(), ny.data(), nz.data(), here}, tolerance,
                       words.data());
    for (std::size_t i = 0; i < here; ++i) {
      counts.agree += words[i] == kMeasured;
      counts.conflict += words[i] == kLookedThrough &&
                         (target.dynamic_mask() == nullptr || !target.dynamic_mask()->at({x[i], y[i], z[i]}));
    }
  }
  return counts;
}

}  // namespace

Judgement judge(const Target& target, const Query& query, const Cloud& device_points, const Pose& T_map_sensor,
                double tolerance_m, MapShare map_share, double conflict_weight, const MapPoints* map_points) {
  Judgement result;
  if (device_points.empty()) return result;
  const auto tolerance = static_cast<float>(tolerance_m);
  const double count = static_cast<double>(device_points.size());
  const Eigen::Isometry3f T = T_map_sensor.cast<float>();
  const Counts device = target.views.empty() ? near_bare_target(target, device_points, T)
                                             : device_against_ceiling(target, device_points, T, tolerance);
  result.agree = device.agree / count;
  result.conflict = device.conflict / count;
  result.score = result.agree - conflict_weight * result.conflict;
  if (query.view.empty()) return result;
  if (map_points == nullptr) map_points = target.dynamic ? &target.dynamic->map_points : &target->map_points;
  const SightView::Tally map =
      map_points->seen_by(query.view, T_map_sensor.inverse().cast<float>(), tolerance, map_share);
  const double seen = map.agree + map.conflict;
  if (seen > 0) {
    result.map_agree = map.agree / seen;
    result.map_conflict = map.conflict / seen;
  }
  const std::size_t stride = map_share == MapShare::half ? 2 : 1;
  const double medium = std::max<double>(1.0, static_cast<double>(query.medium.size() / stride));
  result.map_seen = seen / medium;
  result.score += (map.agree - conflict_weight * map.conflict) / medium;
  return result;
}

}  // namespace liloc
