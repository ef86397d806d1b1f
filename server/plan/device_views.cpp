#include "server/plan/device_views.hpp"

#include <cmath>
#include <numbers>

namespace liloc::plan {
namespace {

// A signature's range is the same within so much: what a grid of places lets a true twin differ by. By hand.
constexpr float kAlike_m = 0.3F, kAlikeShare = 0.05F;
constexpr double kElsewhere_m = 1.0;  // nearer is the same place; by hand
constexpr int kOtherWay = 2;          // directions apart that are another one at the same place; by hand

using Signature = std::vector<float>;

/// Whether two views are of places that a device must not confuse.
bool apart(const DeviceView& a, const DeviceView& b) {
  if ((a.T_map_sensor.translation() - b.T_map_sensor.translation()).head<2>().norm() > kElsewhere_m)
    return true;
  const int turn = std::abs(a.direction - b.direction);
  return std::min(turn, DeviceModel::kDirections - turn) >= kOtherWay;
}

/// How many ranges are the same; what is farther than both see says nothing, and counts as the same.
int same_ranges(const Signature& a, const Signature& b, int most_wrong) {
  int wrong = 0;
  for (std::size_t i = 0; i < a.size() && wrong <= most_wrong; ++i)
    wrong += std::abs(a[i] - b[i]) > kAlike_m + kAlikeShare * std::min(a[i], b[i]) ? 1 : 0;
  return static_cast<int>(a.size()) - wrong;
}

/// Of each view the one that looks most alike, by comparing all pairs.
std::vector<Twin> find_twins(const std::vector<DeviceView>& views, const std::vector<Signature>& signatures) {
  std::vector<Twin> twins(views.size());
  std::vector<int> best(views.size(), 0);
  const int cells = SensorRays::kGridColumns * SensorRays::kGridRows;
  for (std::size_t a = 0; a < views.size(); ++a)
    for (std::size_t b = a + 1; b < views.size(); ++b) {
      if (!apart(views[a], views[b])) continue;
      const int same = same_ranges(signatures[a], signatures[b], cells - std::min(best[a], best[b]));
      if (same > best[a]) best[a] = same, twins[a] = {b, static_cast<double>(same) / cells};
      if (same > best[b]) best[b] = same, twins[b] = {a, static_cast<double>(same) / cells};
    }
  return twins;
}

void index_viewers(const VoxelRoom& room, DeviceViews& all) {
  all.viewers_of.assign(room.surfaces() + 1, 0);
  for (const DeviceView& view : all.views)
    for (const Surface s : view.seen) ++all.viewers_of[s + 1];
  for (std::size_t s = 0; s < room.surfaces(); ++s) all.viewers_of[s + 1] += all.viewers_of[s];
  all.viewers.resize(all.viewers_of.back());
  std::vector<std::uint32_t> next(all.viewers_of.begin(), all.viewers_of.end() - 1);
  for (std::size_t v = 0; v < all.views.size(); ++v)
    for (const Surface s : all.views[v].seen) all.viewers[next[s]++] = static_cast<std::uint32_t>(v);
}

}  // namespace

Pose looking(const Eigen::Vector3d& from_map, double azimuth_rad, double down_rad) {
  const Eigen::Vector3d forward(std::cos(down_rad) * std::cos(azimuth_rad),
                                std::cos(down_rad) * std::sin(azimuth_rad), -std::sin(down_rad));
  const Eigen::Vector3d right(std::sin(azimuth_rad), -std::cos(azimuth_rad), 0);
  Pose T = Pose::Identity();
  T.linear() << right, forward.cross(right), forward;
  T.translation() = from_map;
  return T;
}

DeviceViews look_around(const VoxelRoom& room, const FreeFloor& floor, const DeviceModel& device,
                        const std::function<void(double)>& on_progress) {
  const SensorRays rays(device.camera, device.range_m);
  DeviceViews all;
  std::vector<Signature> signatures;
  for (std::size_t place = 0; place < floor.places_map.size(); ++place) {
    for (const double height_m : device.heights_m)
      for (int direction = 0; direction < DeviceModel::kDirections; ++direction) {
        Eigen::Vector3d from;
        from << floor.places_map[place].cast<double>(), floor.floor_z_m + height_m;
        const double azimuth_rad = 2 * std::numbers::pi * direction / DeviceModel::kDirections;
        const Pose T = looking(from, azimuth_rad, device.down_rad);
        all.views.push_back({place, direction, T, rays.seen(room, T)});
        signatures.push_back(rays.ranges(room, T));
      }
    on_progress(static_cast<double>(place + 1) / static_cast<double>(floor.places_map.size()));
  }
  all.twins = find_twins(all.views, signatures);
  index_viewers(room, all);
  return all;
}

}  // namespace liloc::plan
