#include "proto-tests/sim/write_recording.hpp"

#include <gmock/gmock.h>

#include "common/recording/files.hpp"
#include "common/recording/recording.hpp"
#include "common/recording/tests/temporary_folder.hpp"
#include "proto-tests/sim/simulation.hpp"

namespace liloc::sim {
namespace {

SimOptions two_devices() {
  SimOptions options;
  options.seed = 31;
  options.devices = 2;
  options.seconds = 3;
  options.still_seconds = 1;
  options.image_width = 64;
  options.image_height = 48;
  options.device_clock_offset_ms = 70;
  return options;
}

TEST(WriteRecording, OpensAsWhatWasSimulated) {
  const TemporaryFolder folder;
  const auto root = folder.path() / "rec";
  double last = 0;
  const auto written = write_recording(two_devices(), root, [&](double share) {
    EXPECT_GE(share, last);
    last = share;
  });
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(last, 1);
  const auto recording = open_recording(root);
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->devices.size(), 2u);
  ASSERT_EQ(recording->lidars.size(), 3u);

  auto simulation = Simulation::create(two_devices());
  ASSERT_TRUE(simulation);
  std::vector<std::size_t> lidar_frames(3), device_frames(2), imu_samples(2);
  while (const auto event = simulation->next()) {
    if (const auto* frame = std::get_if<LidarFrame>(&event->payload)) {
      const auto& file = recording->lidars[frame->lidar].depth.at(lidar_frames[frame->lidar]++);
      ASSERT_EQ(file.stamp_ns, frame->image.stamp_ns);
    } else if (const auto* seen = std::get_if<DeviceFrame>(&event->payload)) {
      const DeviceRecording& device = recording->devices[seen->device];
      const std::size_t i = device_frames[seen->device]++;
      ASSERT_EQ(device.depth.at(i).stamp_ns, seen->image.stamp_ns);
      EXPECT_EQ(read_depth(device.depth[i], device.info.camera)->units, seen->image.units);
      const auto truth = read_ground_truth(device);
      ASSERT_TRUE(truth);
      EXPECT_EQ(truth->at(i).stamp_ns, seen->image.stamp_ns);
      EXPECT_LT(distance_m(truth->at(i).T_map_sensor, seen->T_map_sensor), 1e-6);
    } else {
      ++imu_samples[std::get<DeviceImu>(event->payload).device];
    }
  }
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(recording->devices[i].depth.size(), device_frames[i]);
    EXPECT_EQ(recording->devices[i].imu.size(), imu_samples[i]);
  }
  const auto ply = read_file(root / "reference.ply", 1 << 28);
  ASSERT_TRUE(ply);
  EXPECT_THAT(ply->substr(0, 60), testing::StartsWith("ply\nformat binary_little_endian 1.0\nelement vertex"));
}

TEST(WriteRecording, RefusesToMixTwoRecordings) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "global");
  const auto written = write_recording(two_devices(), folder.path());
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, testing::HasSubstr("global"));
}

}  // namespace
}  // namespace liloc::sim
