#include "common/registration/map_points.hpp"

namespace liloc {
namespace {

Vectors every_other_first(const std::vector<Eigen::Vector3f>& points) {
  Vectors vectors(points.size());
  const std::size_t half = (points.size() + 1) / 2;
  for (std::size_t i = 0; i < points.size(); ++i) vectors.set(i % 2 == 0 ? i / 2 : half + i / 2, points[i]);
  return vectors;
}

}  // namespace

MapPoints::MapPoints(const std::vector<Eigen::Vector3f>& sound, const std::vector<Eigen::Vector3f>& stale)
    : sound_(every_other_first(sound)),
      stale_(every_other_first(stale)),
      sound_count_(sound.size()),
      stale_count_(stale.size()) {}

SightView::Tally MapPoints::seen_by(const SightView& view, const Eigen::Isometry3f& T_sensor_map,
                                    float tolerance_m, MapShare share) const {
  const std::size_t stride = share == MapShare::half ? 2 : 1;
  SightView::Tally tally = view.tally(sound_, (sound_count_ + stride - 1) / stride, T_sensor_map, tolerance_m);
  tally.agree += view.tally(stale_, (stale_count_ + stride - 1) / stride, T_sensor_map, tolerance_m).agree;
  return tally;
}

}  // namespace liloc
