#include "server/plan/evaluation.hpp"

#include <algorithm>
#include <numeric>

namespace liloc::plan {
namespace {

using Seen = std::vector<std::vector<Surface>>;

double mean(const std::vector<double>& values) {
  return values.empty()
             ? 0
             : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// How many surfaces of a sorted list are in another.
std::size_t shared(const std::vector<Surface>& a, const std::vector<Surface>& b) {
  std::size_t count = 0;
  auto other = b.begin();
  for (const Surface s : a) {
    other = std::lower_bound(other, b.end(), s);
    count += other != b.end() && *other == s ? 1 : 0;
  }
  return count;
}

void add_hit_rates(const DeviceViews& devices, const Seen& seen, std::vector<LidarWorth>& worth) {
  double views = 0;
  for (const DeviceView& view : devices.views) {
    std::size_t most = 0, best = 0;
    for (std::size_t i = 0; i < seen.size(); ++i)
      if (const std::size_t count = shared(view.seen, seen[i]); count > most) most = count, best = i;
    if (most == 0) continue;
    worth[best].hit_rate += 1;
    views += 1;
  }
  for (LidarWorth& one : worth) one.hit_rate /= std::max(1.0, views);
}

std::vector<LidarWorth> worths(const VoxelRoom& room, const DeviceViews& devices, const Seen& seen,
                               Coverage& coverage) {
  std::vector<LidarWorth> worth(seen.size());
  const double share = coverage.localizable_share();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    std::size_t voxels = 0;
    for (std::size_t k = 0; k < seen[i].size(); ++k)
      voxels += k == 0 || seen[i][k] / 2 != seen[i][k - 1] / 2 ? 1 : 0;
    worth[i].coverage = static_cast<double>(voxels) / static_cast<double>(room.voxels());
    coverage.remove(seen[i]);
    worth[i].lost = share - coverage.localizable_share();
    coverage.add(seen[i]);
  }
  add_hit_rates(devices, seen, worth);
  return worth;
}

void add_places(const FreeFloor& floor, const DeviceViews& devices, Evaluation& evaluation) {
  const std::size_t places = floor.places_map.size();
  std::vector<double> sum(places, 0), count(places, 0), best(places, 0);
  for (std::size_t i = 0; i < devices.views.size(); ++i) {
    const std::size_t place = devices.views[i].place;
    sum[place] += evaluation.chances[i];
    count[place] += 1;
    best[place] = std::max(best[place], evaluation.chances[i]);
  }
  for (std::size_t p = 0; p < places; ++p) {
    evaluation.place_chance.push_back(sum[p] / std::max(1.0, count[p]));
    evaluation.blind.push_back(best[p] < kBlindChance);
  }
  const auto blind = static_cast<double>(std::ranges::count(evaluation.blind, true));
  evaluation.blind_m2 = floor.area_m2 * blind / static_cast<double>(std::max<std::size_t>(1, places));
}

}  // namespace

Evaluation evaluate(const VoxelRoom& room, const FreeFloor& floor, const DeviceViews& devices,
                    const std::vector<HungLidar>& lidars) {
  Seen seen;
  for (const HungLidar& lidar : lidars)
    seen.push_back(SensorRays(lidar.camera, lidar.range_m).seen(room, lidar.T_map_sensor));
  Coverage coverage(room, devices);
  for (const auto& one : seen) coverage.add(one);
  Evaluation evaluation;
  evaluation.coverage = coverage.covered_share();
  evaluation.localizable = coverage.localizable_share();
  for (std::size_t i = 0; i < devices.views.size(); ++i) {
    evaluation.chances.push_back(coverage.chance(i));
    const ViewFeatures features = coverage.features(i);
    evaluation.overlaps.push_back(features.support.covered / std::max(1.0, features.seen));
  }
  evaluation.overlap = mean(evaluation.overlaps);
  for (Surface s = 0; s < room.surfaces(); s += 2)
    evaluation.covered.push_back(coverage.covers(s) || coverage.covers(s + 1));
  evaluation.lidars = worths(room, devices, seen, coverage);
  add_places(floor, devices, evaluation);
  return evaluation;
}

}  // namespace liloc::plan
