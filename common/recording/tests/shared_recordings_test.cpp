// The recordings that come with the project, where they lie beside the checkout.
#include <fmt/core.h>
#include <gmock/gmock.h>

#include "common/recording/recording.hpp"

namespace liloc {
namespace {

const std::filesystem::path kFolder = "../shared/recordings";  // tests run in the project's root

class SharedRecording : public testing::TestWithParam<const char*> {};

TEST_P(SharedRecording, OpensAndItsFirstFramesDecode) {
  const auto root = kFolder / GetParam();
  if (!std::filesystem::exists(root)) GTEST_SKIP() << root << " is absent";
  const auto recording = open_recording(root);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_FALSE(recording->lidars.empty());
  for (const auto& lidar : recording->lidars) {
    ASSERT_GT(lidar.depth.size(), 0u) << lidar.info.id;
    const auto image = read_depth(lidar.depth.front(), lidar.info.camera);
    EXPECT_TRUE(image) << image.error().message;
  }
  for (const auto& device : recording->devices) {
    ASSERT_GT(device.depth.size(), 0u) << device.info.id;
    const auto image = read_depth(device.depth.front(), device.info.camera);
    EXPECT_TRUE(image) << image.error().message;
    EXPECT_EQ(device.imu.empty(), !device.info.imu_rate_hz.has_value());
    const auto truth = read_ground_truth(device);
    ASSERT_TRUE(truth) << truth.error().message;
    ASSERT_EQ(truth->size(), device.depth.size());
    EXPECT_NEAR(to_ms(truth->front().stamp_ns - device.depth.front().stamp_ns), 0, 0.01);
  }
}
INSTANTIATE_TEST_SUITE_P(All, SharedRecording,
                         testing::Values("office-quiet", "office-crowded", "robot-offset", "kitchen-real",
                                         "lab-l515"));

}  // namespace
}  // namespace liloc
