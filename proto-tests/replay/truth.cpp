#include "proto-tests/replay/truth.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <unordered_map>

#include "common/geometry/voxel.hpp"

namespace liloc::replay {
namespace {

using Points = std::vector<Eigen::Vector3d>;

// Yardsticks, by hand: points overlap within one and a half voxels; ranges are those of DepthOptions and of a
// device's default.
constexpr double kVoxelM = 0.05, kNearM = 0.075, kMinRangeM = 0.25, kCeilingRangeM = 8.5, kDeviceRangeM = 6.0;
constexpr StampNs kFrameTolerance_ns = from_ms(5), kCeilingTolerance_ns = from_ms(100);

/// All pixels within range, unfiltered: the yardstick must not depend on the system's own filters.
Points points_of(const DepthImage& image, const Camera& camera, double max_range_m) {
  Points points;
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u) {
      const double z = image.at(u, v) * camera.depth_scale_m;
      if (z > kMinRangeM && z < max_range_m)
        points.emplace_back((u - camera.cx) / camera.fx * z, (v - camera.cy) / camera.fy * z, z);
    }
  return points;
}

std::uint64_t key_at(const Eigen::Vector3d& p, double size) {
  return cell_key((p / size).array().floor().cast<int>());
}

/// Mean per voxel; the grid starts half a voxel below the cloud's lowest corner, as Open3D's does.
Points voxel_means(const Points& points) {
  if (points.empty()) return {};
  Eigen::Vector3d low = points.front();
  for (const auto& p : points) low = low.cwiseMin(p);
  low.array() -= kVoxelM / 2;
  std::unordered_map<std::uint64_t, std::pair<Eigen::Vector3d, int>> sums;
  for (const auto& p : points) {
    auto& [sum, count] = sums.try_emplace(key_at(p - low, kVoxelM), Eigen::Vector3d::Zero(), 0).first->second;
    sum += p;
    ++count;
  }
  Points means;
  means.reserve(sums.size());
  for (const auto& [key, sum] : sums) means.push_back(sum.first / sum.second);
  return means;
}

/// Answers "is any point within kNearM?" from the 27 cells around.
class NearGrid {
 public:
  explicit NearGrid(const Points& points) {
    for (const auto& p : points) cells_[key_at(p, kNearM)].push_back(p);
  }
  [[nodiscard]] bool any_near(const Eigen::Vector3d& p) const {
    for (int i = 0; i < 27; ++i) {
      const Eigen::Vector3d offset = Eigen::Vector3i(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1).cast<double>();
      const auto cell = cells_.find(key_at(p + offset * kNearM, kNearM));
      if (cell == cells_.end()) continue;
      for (const auto& q : cell->second)
        if ((p - q).squaredNorm() < kNearM * kNearM) return true;
    }
    return false;
  }

 private:
  std::unordered_map<std::uint64_t, Points> cells_;
};

std::size_t nearest_index(const std::vector<DepthFile>& files, StampNs stamp_ns) {
  const auto nearer = [stamp_ns](const DepthFile& a, const DepthFile& b) {
    return std::llabs(a.stamp_ns - stamp_ns) < std::llabs(b.stamp_ns - stamp_ns);
  };
  return static_cast<std::size_t>(std::min_element(files.begin(), files.end(), nearer) - files.begin());
}

}  // namespace

Result<Truth> Truth::of(const DeviceRecording& device) {
  const auto rows = read_ground_truth(device);
  if (!rows) return tl::unexpected(rows.error());
  Truth truth;
  if (rows->empty()) return truth;
  if (rows->size() != device.depth.size())
    return fail("{}: {} poses for {} depth frames; the ground truth must have one row per frame",
                (device.folder / "groundtruth.tum").string(), rows->size(), device.depth.size());
  for (std::size_t i = 0; i < rows->size(); ++i) {
    truth.stamps_.push_back(device.depth[i].stamp_ns);
    truth.poses_.push_back((*rows)[i].T_map_sensor);
  }
  return truth;
}

std::ptrdiff_t Truth::frame_near(StampNs stamp_ns) const {
  const auto nearer = [stamp_ns](StampNs a, StampNs b) {
    return std::llabs(a - stamp_ns) < std::llabs(b - stamp_ns);
  };
  const auto best = std::min_element(stamps_.begin(), stamps_.end(), nearer);
  return best == stamps_.end() || std::llabs(*best - stamp_ns) > kFrameTolerance_ns ? -1
                                                                                    : best - stamps_.begin();
}

double Truth::path_m() const {
  double length = 0;
  for (std::size_t i = 1; i < poses_.size(); ++i)
    length += (poses_[i].translation() - poses_[i - 1].translation()).norm();
  return length;
}

double overlap_at_truth(const std::vector<PlacedFrame>& ceiling, const PlacedFrame& device) {
  Points all;
  for (const PlacedFrame& frame : ceiling)
    for (const auto& p : points_of(frame.image, frame.camera, kCeilingRangeM))
      all.push_back(frame.T_map_sensor * p);
  const Points seen = voxel_means(points_of(device.image, device.camera, kDeviceRangeM));
  if (all.empty() || seen.empty()) return 0;
  const NearGrid grid(voxel_means(all));
  const auto near = std::count_if(seen.begin(), seen.end(),
                                  [&](const auto& p) { return grid.any_near(device.T_map_sensor * p); });
  return static_cast<double>(near) / static_cast<double>(seen.size());
}

double overlap_at_truth(const Recording& recording, const DeviceRecording& device, const DepthFile& frame,
                        const Pose& T_map_sensor) {
  std::vector<DepthImage> images;
  std::vector<const GlobalLidar*> lidars;
  for (const LidarRecording& lidar : recording.lidars) {
    if (lidar.depth.empty()) continue;
    const DepthFile& file = lidar.depth[nearest_index(lidar.depth, frame.stamp_ns)];
    if (std::llabs(file.stamp_ns - frame.stamp_ns) > kCeilingTolerance_ns) continue;
    Result<DepthImage> image = read_depth(file, lidar.info.camera);
    if (!image) continue;  // a corrupt frame is no frame
    images.push_back(std::move(*image));
    lidars.push_back(&lidar.info);
  }
  std::vector<PlacedFrame> ceiling;
  for (std::size_t i = 0; i < images.size(); ++i)
    ceiling.push_back({images[i], lidars[i]->camera, lidars[i]->T_map_sensor});
  const Result<DepthImage> image = read_depth(frame, device.info.camera);
  return image ? overlap_at_truth(ceiling, {*image, device.info.camera, T_map_sensor}) : 0;
}

}  // namespace liloc::replay
