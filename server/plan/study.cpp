#include "server/plan/study.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace liloc::plan {
namespace {

using Seen = std::vector<Surface>;

constexpr double kHumanLevel_m = 1.5, kBetween_m = 2.5;  // Table 2: a person's height; and one between
constexpr double kTilts_deg[] = {15, 30, 45, 60, 75};    // Table 3
constexpr int kChoices = 200;                            // of LiDARs, for Figure 7; by hand

/// How a LiDAR looks, told from its pose.
Mount mount_of(const Pose& T_map_sensor) {
  const Eigen::Vector3d forward = T_map_sensor.linear().col(2);
  return {T_map_sensor.translation(), std::atan2(forward.y(), forward.x()),
          std::asin(std::clamp(-forward.z(), -1.0, 1.0))};
}

class PlacementStudy {
 public:
  PlacementStudy(const VoxelRoom& room, const FreeFloor& floor, const DeviceViews& devices,
                 const std::vector<HungLidar>& lidars, const std::function<void(double)>& on_progress)
      : room_(room), floor_(floor), devices_(devices), lidars_(lidars), on_progress_(on_progress) {
    for (const HungLidar& lidar : lidars) rays_.emplace_back(lidar.camera, lidar.range_m);
  }

  Study run() {
    Study study;
    study.heights = heights();
    on_progress_(0.3);
    study.tilts = tilts();
    on_progress_(0.7);
    study.counts = counts();
    on_progress_(1);
    return study;
  }

 private:
  /// What each LiDAR sees with its mount changed.
  template <class Change>
  std::vector<Seen> seen_with(const Change& change) const {
    std::vector<Seen> all;
    for (std::size_t i = 0; i < lidars_.size(); ++i) {
      Mount mount = mount_of(lidars_[i].T_map_sensor);
      change(mount);
      all.push_back(rays_[i].seen(room_, mount.T_map_sensor()));
    }
    return all;
  }

  std::vector<Seen> seen_as_hung() const {
    std::vector<Seen> all;
    for (std::size_t i = 0; i < lidars_.size(); ++i)
      all.push_back(rays_[i].seen(room_, lidars_[i].T_map_sensor));
    return all;
  }

  Coverage coverage_of(const std::vector<Seen>& seen) const {
    Coverage coverage(room_, devices_);
    for (const Seen& one : seen) coverage.add(one);
    return coverage;
  }

  std::vector<HeightRow> heights() const {
    double hung_m = 0;
    for (const HungLidar& lidar : lidars_)
      hung_m += (lidar.T_map_sensor.translation().z() - floor_.floor_z_m) / static_cast<double>(lidars_.size());
    std::vector<HeightRow> rows;
    const auto add = [&](double above_m, const std::vector<Seen>& seen) {
      const Coverage coverage = coverage_of(seen);
      const double share = coverage.covered_share();
      rows.push_back({above_m, share, coverage.localizable_share(),
                      static_cast<std::size_t>(std::lround(share * static_cast<double>(room_.voxels())))});
    };
    for (const double above_m : {kHumanLevel_m, kBetween_m})
      if (above_m < hung_m)
        add(above_m, seen_with([&](Mount& mount) {
              mount.at_map.z() = floor_.floor_z_m + above_m;
              if (above_m <= kHumanLevel_m) mount.down_rad = 0;
            }));
    add(hung_m, seen_as_hung());
    return rows;
  }

  std::vector<TiltRow> tilts() const {
    std::vector<TiltRow> rows;
    std::vector<Seen> any(lidars_.size());
    std::vector<std::vector<Seen>> at;
    for (const double down_deg : kTilts_deg) {
      at.push_back(seen_with([&](Mount& mount) { mount.down_rad = radians(down_deg); }));
      for (std::size_t i = 0; i < any.size(); ++i) {
        Seen both;
        std::ranges::set_union(any[i], at.back()[i], std::back_inserter(both));
        any[i] = std::move(both);
      }
    }
    for (std::size_t k = 0; k < at.size(); ++k) {
      double overlap = 0;
      for (std::size_t i = 0; i < any.size(); ++i)
        overlap += static_cast<double>(at[k][i].size()) / std::max(1.0, static_cast<double>(any[i].size()));
      rows.push_back(
          {kTilts_deg[k], overlap / static_cast<double>(any.size()), coverage_of(at[k]).localizable_share()});
    }
    return rows;
  }

  std::vector<CountRow> counts() const {
    const std::vector<Seen> seen = seen_as_hung();
    std::vector<std::size_t> order(seen.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::mt19937_64 rng(1);
    std::vector<CountRow> rows;
    for (std::size_t n = 1; n <= seen.size(); ++n) {
      CountRow row{n, 1, 0, 0};
      for (int choice = 0; choice < kChoices; ++choice) {
        for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[rng() % i]);
        std::vector<bool> covered(room_.voxels(), false);
        for (std::size_t i = 0; i < n; ++i)
          for (const Surface s : seen[order[i]]) covered[s / 2] = true;
        const double share =
            static_cast<double>(std::ranges::count(covered, true)) / static_cast<double>(room_.voxels());
        row.least = std::min(row.least, share);
        row.most = std::max(row.most, share);
        row.mean += share / kChoices;
      }
      rows.push_back(row);
    }
    return rows;
  }

  const VoxelRoom& room_;
  const FreeFloor& floor_;
  const DeviceViews& devices_;
  const std::vector<HungLidar>& lidars_;
  const std::function<void(double)>& on_progress_;
  std::vector<SensorRays> rays_;
};

}  // namespace

Study study_placement(const VoxelRoom& room, const FreeFloor& floor, const DeviceViews& devices,
                      const std::vector<HungLidar>& lidars, const std::function<void(double)>& on_progress) {
  return PlacementStudy(room, floor, devices, lidars, on_progress).run();
}

}  // namespace liloc::plan
