// Two real L515 looked at one lab from known poses: reading, intrinsics and extrinsics are right only if their
// clouds agree in the map as well as was measured when the recording was made.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <unordered_map>

#include "common/geometry/depth.hpp"
#include "common/geometry/voxel.hpp"
#include "common/recording/recording.hpp"

namespace liloc {
namespace {

constexpr float kPairDistance = 0.05F;

using Grid = std::unordered_map<std::uint64_t, std::vector<Eigen::Vector3f>>;

Cloud cloud_map(const LidarRecording& lidar, const DepthFile& file) {
  const auto image = read_depth(file, lidar.info.camera);
  if (!image) return {};
  DepthOptions options;  // 0.25 to 8.5 m
  options.flying_pixel_share = 0;
  return transformed(lidar.info.T_map_sensor, *depth_to_cloud(*image, lidar.info.camera, options));
}

float nearest_m(const Grid& grid, const Eigen::Vector3f& p) {
  float best = std::numeric_limits<float>::max();
  const Eigen::Vector3i cell = cell_of(p, 1 / kPairDistance);
  for (int i = 0; i < 27; ++i) {
    const auto found = grid.find(cell_key(cell + Eigen::Vector3i(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)));
    if (found == grid.end()) continue;
    for (const auto& q : found->second) best = std::min(best, (q - p).squaredNorm());
  }
  return std::sqrt(best);
}

TEST(LabL515, TheTwoCloudsAgreeInTheMap) {
  const std::filesystem::path root = "../shared/recordings/lab-l515";
  if (!std::filesystem::exists(root)) GTEST_SKIP() << root << " is absent";
  const auto recording = open_recording(root);
  ASSERT_TRUE(recording) << recording.error().message;
  const auto &first = recording->lidars.at(0), &second = recording->lidars.at(1);
  const auto& file = first.depth.at(first.depth.size() / 2);
  const auto& partner = *std::ranges::min_element(
      second.depth, {}, [&](const DepthFile& other) { return std::llabs(other.stamp_ns - file.stamp_ns); });
  ASSERT_LT(std::llabs(partner.stamp_ns - file.stamp_ns), from_ms(100));

  Grid grid;
  for (const auto& p : cloud_map(first, file).points)
    grid[cell_key(cell_of(p, 1 / kPairDistance))].push_back(p);
  const Cloud scan = cloud_map(second, partner);
  std::vector<float> paired_mm;
  std::size_t asked = 0;
  for (std::size_t i = 0; i < scan.size(); i += 3, ++asked)
    if (const float d = nearest_m(grid, scan.points[i]); d < kPairDistance) paired_mm.push_back(1000 * d);
  ASSERT_GT(asked, 10'000u);
  std::ranges::nth_element(paired_mm, paired_mm.begin() + static_cast<std::ptrdiff_t>(paired_mm.size() / 2));
  EXPECT_NEAR(static_cast<double>(paired_mm.size()) / static_cast<double>(asked), 0.43, 0.03);
  EXPECT_NEAR(paired_mm[paired_mm.size() / 2], 12, 4);
}

}  // namespace
}  // namespace liloc
