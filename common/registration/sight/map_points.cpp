#include "common/registration/sight/map_points.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace liloc {
namespace {

// Points of a run with a ball about it, and runs asked at once; by hand, for speed alone.
constexpr std::size_t kRun = 32, kRunsAtOnce = 256;
constexpr float kRounding_m = 1e-3F;  // above what floats round indoors; by hand

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

MapPoints::Runs::Runs(std::vector<Eigen::Vector3f> given, MapOrder order)
    : count(given.size()), points(count), centres((count + kRun - 1) / kRun) {
  if (order == MapOrder::together) bring_together(given.begin(), given.end());
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

std::array<MapPoints::Runs, 2> MapPoints::every_other(const std::vector<Eigen::Vector3f>& points,
                                                      MapOrder order) {
  std::array<std::vector<Eigen::Vector3f>, 2> parts;
  for (std::size_t i = 0; i < points.size(); ++i) parts[i % 2].push_back(points[i]);
  return {Runs(std::move(parts[0]), order), Runs(std::move(parts[1]), order)};
}

MapPoints::MapPoints(const std::vector<Eigen::Vector3f>& sound, const std::vector<Eigen::Vector3f>& stale,
                     MapOrder order)
    : sound_(every_other(sound, order)), stale_(every_other(stale, order)) {}

SightView::Tally MapPoints::tally(const Runs& runs, const Placed& placed) {
  SightView::Tally sum;
  const auto add = [&](std::size_t first_run, std::size_t end_run) {
    const std::size_t begin = first_run * kRun, end = std::min(end_run * kRun, runs.count);
    const SightView::Tally more =
        placed.view.tally(runs.points.run(begin, end - begin), placed.T_sensor_map, placed.tolerance_m);
    sum.agree += more.agree;
    sum.conflict += more.conflict;
  };
  std::array<std::int32_t, kRunsAtOnce> in_view;
  for (std::size_t begin = 0; begin < runs.radii.size(); begin += kRunsAtOnce) {
    const std::size_t here = std::min(kRunsAtOnce, runs.radii.size() - begin);
    std::fill_n(in_view.begin(), here, 1);
    reach_into(placed.bounds.data(), placed.bounds.size(), runs.centres.run(begin, here),
               runs.radii.data() + begin, in_view.data());
    for (std::size_t i = 0; i < here; ++i) {
      const std::size_t first = i;
      while (i < here && in_view[i] != 0) ++i;
      if (i > first) add(begin + first, begin + i);
    }
  }
  return sum;
}

SightView::Tally MapPoints::seen_by(const SightView& view, const Eigen::Isometry3f& T_sensor_map,
                                    float tolerance_m, MapShare share) const {
  const Placed placed{view, T_sensor_map, tolerance_m, view.bounds(T_sensor_map, tolerance_m)};
  SightView::Tally sum;
  for (std::size_t part = 0; part < (share == MapShare::half ? 1 : 2); ++part) {
    const SightView::Tally sound = tally(sound_[part], placed);
    sum.agree += sound.agree + tally(stale_[part], placed).agree;
    sum.conflict += sound.conflict;
  }
  return sum;
}

}  // namespace liloc
