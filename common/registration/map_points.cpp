#include "common/registration/map_points.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace liloc {
namespace {

constexpr std::size_t kRun = 32;
constexpr float kRounding_m = 1e-3F;

using PointIter = std::vector<Eigen::Vector3f>::iterator;

Eigen::AlignedBox3f box_of(PointIter first, PointIter last) {
  Eigen::AlignedBox3f box;
  for (PointIter p = first; p != last; ++p) box.extend(*p);
  return box;
}

/// Halves across the longest side until what is left is a run.
void bring_together(PointIter first, PointIter last) {
  const auto count = static_cast<std::size_t>(last - first);
  if (count <= kRun) return;
  Eigen::Index axis = 0;
  box_of(first, last).sizes().maxCoeff(&axis);
  const auto middle = first + static_cast<std::ptrdiff_t>((count / 2 + kRun - 1) / kRun * kRun);
  std::nth_element(first, middle, last,
                   [axis](const Eigen::Vector3f& a, const Eigen::Vector3f& b) { return a[axis] < b[axis]; });
  bring_together(first, middle);
  bring_together(middle, last);
}

}  // namespace

MapPoints::Runs::Runs(std::vector<Eigen::Vector3f> given)
    : count(given.size()), points(count), centres((count + kRun - 1) / kRun) {
  bring_together(given.begin(), given.end());
  for (std::size_t i = 0; i < count; ++i) points.set(i, given[i]);
  for (std::size_t begin = 0; begin < count; begin += kRun) {
    const auto first = given.begin() + static_cast<std::ptrdiff_t>(begin),
               last = given.begin() + static_cast<std::ptrdiff_t>(std::min(begin + kRun, count));
    const Eigen::Vector3f centre = box_of(first, last).center();
    float squared = 0;
    for (PointIter p = first; p != last; ++p) squared = std::max(squared, (*p - centre).squaredNorm());
    centres.set(begin / kRun, centre);
    radii.push_back(std::sqrt(squared) + kRounding_m);
  }
}

std::array<MapPoints::Runs, 2> MapPoints::every_other(const std::vector<Eigen::Vector3f>& points) {
  std::array<std::vector<Eigen::Vector3f>, 2> parts;
  for (std::size_t i = 0; i < points.size(); ++i) parts[i % 2].push_back(points[i]);
  return {Runs(std::move(parts[0])), Runs(std::move(parts[1]))};
}

MapPoints::MapPoints(const std::vector<Eigen::Vector3f>& sound, const std::vector<Eigen::Vector3f>& stale)
    : sound_(every_other(sound)), stale_(every_other(stale)) {}

SightView::Tally MapPoints::tally(const Runs& runs, const SightView& view,
                                  const Eigen::Isometry3f& T_sensor_map, float tolerance_m) {
  const std::array<HalfSpace, 6> bounds = view.bounds(T_sensor_map, tolerance_m);
  const std::size_t count = runs.radii.size();
  std::vector<std::int32_t> in_view(count, 1);
  reach_into(bounds.data(), bounds.size(), runs.centres.run(0, count), runs.radii.data(), in_view.data());
  SightView::Tally tally;
  for (std::size_t begin = 0, end = 0; begin < count; begin = end + 1) {
    end = static_cast<std::size_t>(
        std::find(in_view.begin() + static_cast<std::ptrdiff_t>(begin), in_view.end(), 0) - in_view.begin());
    if (end == begin) continue;
    const std::size_t last = std::min(end * kRun, runs.count);
    const SightView::Tally more =
        view.tally(runs.points.run(begin * kRun, last - begin * kRun), T_sensor_map, tolerance_m);
    tally.agree += more.agree;
    tally.conflict += more.conflict;
  }
  return tally;
}

SightView::Tally MapPoints::seen_by(const SightView& view, const Eigen::Isometry3f& T_sensor_map,
                                    float tolerance_m, MapShare share) const {
  SightView::Tally sum;
  for (std::size_t part = 0; part < (share == MapShare::half ? 1 : 2); ++part) {
    const SightView::Tally sound = tally(sound_[part], view, T_sensor_map, tolerance_m);
    sum.agree += sound.agree + tally(stale_[part], view, T_sensor_map, tolerance_m).agree;
    sum.conflict += sound.conflict;
  }
  return sum;
}

}  // namespace liloc
