#include "common/registration/judge.hpp"

#include <algorithm>

namespace liloc {
namespace {

/// The word of all ceiling views on one device point: one that measured a surface there outweighs one that,
/// past an edge, looked by. Beside somebody who moves, looking by says nothing.
Sight word_of(const Target& target, const Eigen::Vector3f& p_map, float tolerance) {
  Sight word = Sight::unseen;
  for (const SightView& view : target.views) {
    const Sight sight = view.look(p_map, tolerance);
    if (sight == Sight::agrees) return sight;
    if (sight == Sight::conflict) word = sight;
  }
  const bool excused = word == Sight::conflict && target.movers() != nullptr && target.movers()->at(p_map);
  return excused ? Sight::unseen : word;
}

struct Counts {
  int agree = 0, conflict = 0;
};

Counts device_against_ceiling(const Target& target, const Cloud& points, const Eigen::Isometry3f& T,
                              float tolerance) {
  Counts counts;
  for (const Eigen::Vector3f& point : points.points) {
    const Eigen::Vector3f p = T * point;
    if (target.views.empty()) {
      const std::int32_t j = target->nearest.nearest(p);
      counts.agree += j != NearestGrid::kNone;
      continue;
    }
    const Sight sight = word_of(target, p, tolerance);
    counts.agree += sight == Sight::agrees;
    counts.conflict += sight == Sight::conflict;
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
  const Counts device = device_against_ceiling(target, device_points, T_map_sensor.cast<float>(), tolerance);
  result.agree = device.agree / count;
  result.conflict = device.conflict / count;
  result.score = result.agree - conflict_weight * result.conflict;
  if (query.view.empty()) return result;
  if (map_points == nullptr) map_points = target.present ? &target.present->map_points : &target->map_points;
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
