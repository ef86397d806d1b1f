// liloc record against a simulated site that streams, as a user runs both.
#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "common/recording/writer.hpp"
#include "proto-tests/toolbox/tests/program_test.hpp"

namespace liloc::toolbox {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class Record : public ProgramTest {
 protected:
  /// Streams two LiDARs and a device until it goes; its files lie in site/.
  [[nodiscard]] std::jthread streaming(int seconds) const {
    std::jthread site([this, seconds] {
      const Outcome outcome = liloc(
          fmt::format("sim --live --domain 151 --seconds {} --lidars 2 --image-width 160 --image-height 120 "
                      "--describe {}",
                      seconds, path("site")));
      EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
    });
    for (int i = 0; i < 1000 && !fs::exists(path("site/device0.json")); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return site;
  }
  /// Records until a signal that comes after so many seconds.
  [[nodiscard]] Outcome record_until(const std::string& signal, int seconds,
                                     const std::string& more = "") const {
    return run_program("timeout", fmt::format("--preserve-status -s {} {} " LILOC_PROGRAM
                                              " record {} --site {} --device {} --domain 151{}",
                                              signal, seconds, path("rec"), path("site/site.json"),
                                              path("site/device0.json"), more));
  }
};

TEST_F(Record, AnInterruptLeavesAWholeRecording) {
  const std::jthread site = streaming(12);
  const Outcome outcome = record_until("INT", 4);
  ASSERT_EQ(outcome.exit_code, 0) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("device0: "));
  const auto recording = open_recording(path("rec"));
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->lidars.size(), 2U);
  for (const LidarRecording& lidar : recording->lidars) {
    EXPECT_GE(lidar.depth.size(), 3U) << "6 a second";
    for (const DepthFile& frame : lidar.depth) EXPECT_TRUE(read_depth(frame, lidar.info.camera)) << frame.path;
  }
  ASSERT_EQ(recording->devices.size(), 1U);
  EXPECT_GE(recording->devices[0].depth.size(), 10U) << "15 a second";
  EXPECT_GE(recording->devices[0].imu.size(), 100U) << "200 a second";
}

TEST_F(Record, AKillLeavesWhatHadComeUntilThen) {
  const std::jthread site = streaming(6);
  ASSERT_TRUE(write_device(path("silent.json"), {"silent", {80, 60, 60, 60, 39.5, 29.5}, 15, 0, {}, {}}));
  const Outcome outcome = record_until("KILL", 4, " --device " + path("silent.json"));
  EXPECT_NE(outcome.exit_code, 0);
  const auto recording = open_recording(path("rec"));
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->devices.size(), 1U) << "one was never heard";
  const DeviceRecording& device = recording->devices[0];
  ASSERT_FALSE(device.imu.empty());
  EXPECT_LT(std::abs(device.imu.back().stamp_ns - device.depth.back().stamp_ns), from_ms(1000));
}

TEST_F(Record, AFullDiskEndsItAndLeavesWholeFrames) {
  const std::jthread site = streaming(5);
  const Outcome full =
      on_full_disk(600, fmt::format("record {} --site {} --device {} --domain 151 --seconds 60",
                                    path("disk/rec"), path("site/site.json"), path("site/device0.json")));
  expect_told_as_full(full);
  for (const auto& entry : fs::recursive_directory_iterator(path("left/rec")))
    EXPECT_FALSE(entry.path().extension() == ".part") << entry.path();
  const auto recording = open_recording(path("left/rec"));
  ASSERT_TRUE(recording) << recording.error().message;
  std::size_t frames = 0;
  const auto read = [&](const std::vector<DepthFile>& files, const Camera& camera) {
    for (const DepthFile& frame : files) {
      const auto image = read_depth(frame, camera);
      EXPECT_TRUE(image) << image.error().message;
      ++frames;
    }
  };
  for (const LidarRecording& lidar : recording->lidars) read(lidar.depth, lidar.info.camera);
  for (const DeviceRecording& device : recording->devices) read(device.depth, device.info.camera);
  if (full.out.find("No space left") != std::string::npos) {  // else no frame fits into a file
    EXPECT_GT(frames, 3U);
  }
}

TEST_F(Record, SilenceIsToldAndADeviceWithoutFramesIsLeftOut) {
  const Camera camera{80, 60, 60, 60, 39.5, 29.5, 0.001};
  ASSERT_TRUE(write_site(path("site.json"), {"map", {{"ceiling0", camera, 6, Pose::Identity()}}}));
  ASSERT_TRUE(write_device(path("device0.json"), {"device0", camera, 15, 0, 200.0, Pose::Identity()}));
  const Outcome outcome = liloc("record " + path("rec") + " --site " + path("site.json") + " --device " +
                                path("device0.json") + " --domain 152 --seconds 0.3");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("no ceiling LiDAR was heard on domain 152"));
  const auto recording = open_recording(path("rec"));
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_TRUE(recording->devices.empty());
}

TEST_F(Record, BadUsageIsOneLineAndLeavesNothing) {
  const Camera camera{80, 60, 60, 60, 39.5, 29.5, 0.001};
  ASSERT_TRUE(write_site(path("site.json"), {"map", {{"ceiling0", camera, 6, Pose::Identity()}}}));
  ASSERT_TRUE(write_device(path("twin.json"), {"ceiling0", camera, 15, 0, {}, {}}));
  const auto wrong = [&](const std::string& arguments, const std::string& part) {
    expect_refused("record " + arguments, part, "rec");
  };
  wrong(path("rec"), "--site");
  wrong(path("rec") + " --site " + path("absent.json"), "no such file");
  wrong(path("rec") + " --domain 152 --site " + path("site.json") + " --device " + path("twin.json"),
        "two sensors have this id");
  ASSERT_TRUE(write_device(path("one.json"), {"robot-1", camera, 15, 0, {}, {}}));
  ASSERT_TRUE(write_device(path("other.json"), {"robot_1", camera, 15, 0, {}, {}}));
  wrong(path("rec") + " --domain 152 --site " + path("site.json") + " --device " + path("one.json") +
            " --device " + path("other.json"),
        "robot-1 and robot_1 are one in the names of topics");
}

TEST_F(Record, WhatStandsInTheWayIsLeftAlone) {
  const Camera camera{80, 60, 60, 60, 39.5, 29.5, 0.001};
  ASSERT_TRUE(write_site(path("taken/site.json"), {"map", {{"ceiling0", camera, 6, Pose::Identity()}}}));
  const Outcome outcome = liloc("record " + path("taken") + " --domain 152 --site " + path("taken/site.json"));
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.out, HasSubstr("is there already"));
  EXPECT_TRUE(fs::exists(path("taken/site.json")));
}

}  // namespace
}  // namespace liloc::toolbox
