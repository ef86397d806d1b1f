#include "server/plan/placement.hpp"

#include <algorithm>
#include <array>

namespace liloc::plan {
namespace {

// By hand: less than what a bracket is mounted to.
constexpr double kMove_m = 0.4, kTurn_rad = radians(15), kTilt_rad = radians(8);
constexpr double kGain = 1e-6;  // of the share; below, rounding decides

struct Hung {
  Mount mount;
  std::vector<Surface> seen;
};

class Placement {
 public:
  Placement(const VoxelRoom& room, const FreeFloor& floor, const DeviceViews& devices, const LidarModel& lidar,
            const PlacementOptions& options, const std::function<void(double)>& on_progress)
      : room_(room),
        floor_(floor),
        rays_(lidar.camera, lidar.range_m),
        options_(options),
        on_progress_(on_progress),
        coverage_(room, devices) {}

  Result<std::vector<Mount>> run() {
    const auto mounts = possible_mounts(room_, floor_, options_.mounts);
    if (mounts.empty())
      return fail("nowhere can a LiDAR hang at {:.2f} m below a ceiling at z = {:.2f} m; give --height",
                  options_.mounts.below_ceiling_m.front(), options_.mounts.ceiling_z_m);
    // Looks, then greedy additions and swaps, each over all candidates.
    all_ = static_cast<double>(mounts.size()) * (kLook + options_.lidars * (1 + options_.swap_rounds));
    for (const Mount& mount : mounts) {
      candidates_.push_back({mount, rays_.seen(room_, mount.T_map_sensor())});
      progress(kLook);
    }
    for (int i = 0; i < options_.lidars; ++i) hang(best());
    for (int round = 0; round < options_.swap_rounds && swap_each(); ++round) {
    }
    for (int round = 0; round < options_.move_rounds && move_each(); ++round) {
    }
    std::vector<Mount> chosen;
    for (const Hung& hung : hung_) chosen.push_back(hung.mount);
    return chosen;
  }

 private:
  static constexpr double kLook = 8;  // times as long as to try a candidate; for the progress bar

  void progress(double work) { on_progress_(std::min(1.0, (done_ += work) / all_)); }

  void hang(const Hung& one) {
    coverage_.add(one.seen);
    hung_.push_back(one);
  }

  const Hung& best() {
    std::size_t best = 0;
    double best_share = -1;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      const double share = coverage_.share_with(candidates_[i].seen);
      if (share > best_share) best_share = share, best = i;
      progress(1);
    }
    return candidates_[best];
  }

  /// Puts each LiDAR where it is worth most beside the others. Whether any moved.
  bool swap_each() {
    bool moved = false;
    for (Hung& own : hung_) {
      const double before = coverage_.localizable_share();
      coverage_.remove(own.seen);
      const Hung& other = best();
      const bool better = coverage_.share_with(other.seen) > before + kGain;
      if (better) own = other;
      coverage_.add(own.seen);
      moved |= better;
    }
    return moved;
  }

  /// Shifts, turns and tilts each a little where that helps. Whether any moved.
  bool move_each() {
    bool moved = false;
    for (Hung& own : hung_)
      for (const auto& [x, y, turn, tilt] : kMoves) {
        Hung other = own;
        other.mount.at_map += Eigen::Vector3d(x, y, 0);
        other.mount.azimuth_rad += turn;
        other.mount.down_rad = std::clamp(other.mount.down_rad + tilt, radians(10), radians(80));
        if (!can_hang(room_, floor_, other.mount.at_map, 0.8 * options_.mounts.off_wall_m)) continue;
        other.seen = rays_.seen(room_, other.mount.T_map_sensor());
        const double before = coverage_.localizable_share();
        coverage_.remove(own.seen);
        const bool better = coverage_.share_with(other.seen) > before + kGain;
        if (better) own = std::move(other);
        coverage_.add(own.seen);
        moved |= better;
      }
    return moved;
  }

  struct Move {
    double x_m, y_m, turn_rad, tilt_rad;
  };
  static constexpr std::array<Move, 8> kMoves{{{kMove_m, 0, 0, 0},
                                               {-kMove_m, 0, 0, 0},
                                               {0, kMove_m, 0, 0},
                                               {0, -kMove_m, 0, 0},
                                               {0, 0, kTurn_rad, 0},
                                               {0, 0, -kTurn_rad, 0},
                                               {0, 0, 0, kTilt_rad},
                                               {0, 0, 0, -kTilt_rad}}};

  const VoxelRoom& room_;
  const FreeFloor& floor_;
  const SensorRays rays_;
  const PlacementOptions& options_;
  const std::function<void(double)>& on_progress_;
  Coverage coverage_;
  std::vector<Hung> candidates_, hung_;
  double done_ = 0, all_ = 1;
};

}  // namespace

Result<std::vector<Mount>> place_lidars(const VoxelRoom& room, const FreeFloor& floor,
                                        const DeviceViews& devices, const LidarModel& lidar,
                                        const PlacementOptions& options,
                                        const std::function<void(double)>& on_progress) {
  return Placement(room, floor, devices, lidar, options, on_progress).run();
}

}  // namespace liloc::plan
