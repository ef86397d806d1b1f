#include "common/recording/tum_folder.hpp"

#include <gmock/gmock.h>

#include "common/recording/tests/temporary_folder.hpp"
#include "common/recording/writer.hpp"

namespace liloc {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;
constexpr StampNs kStart_ns = 1'305'031'102'160'407'001;

class TumFolder : public testing::Test {
 protected:
  /// A device with two frames: 2 m, but for pixels of 2.001 m, of nothing and of 16 m.
  DeviceRecording recorded() const {
    DeviceRecording device{
        {"robot", {8, 4, 8, 8, 3.5, 1.5, 0.001}, 10, 0, {}, {}}, folder_.path() / "robot", {}, {}};
    for (const StampNs at : {kStart_ns, kStart_ns + 100'000'000}) {
      DepthImage image{at, 8, 4, std::vector<std::uint16_t>(32, 2000)};
      image.units[1] = 2001;
      image.units[2] = 0;
      image.units[3] = 16'000;
      EXPECT_TRUE(write_depth(device.folder / "depth", image));
      device.depth.push_back({at, device.folder / "depth" / fmt::format("{}.png", at)});
    }
    EXPECT_TRUE(
        write_tum(device.folder / "groundtruth.tum", {{kStart_ns, Pose(Eigen::Translation3d(1, 2, 3))}}));
    return device;
  }
  std::string error_of(const std::string& table) {
    folder_.put("tum/depth.txt", table);
    const auto frames = tum_to_device(folder_.path() / "tum", folder_.path() / "rec", recorded().info);
    return frames ? "" : frames.error().message;
  }
  const TemporaryFolder folder_;
};

TEST_F(TumFolder, ThereAndBackIsTheSameToItsUnit) {
  const DeviceRecording device = recorded();
  ASSERT_TRUE(device_to_tum(device, folder_.path() / "tum"));
  ASSERT_TRUE(is_tum_folder(folder_.path() / "tum"));
  const auto frames = tum_to_device(folder_.path() / "tum", folder_.path() / "rec", device.info);
  ASSERT_TRUE(frames) << frames.error().message;
  EXPECT_EQ(*frames, 2U);
  const fs::path back = folder_.path() / "rec/devices/robot";
  const auto info = read_device(back / "device.json");
  ASSERT_TRUE(info) << info.error().message;
  EXPECT_EQ(info->camera.depth_scale_m, 0.0002);
  EXPECT_NEAR(info->rate_hz, 10, 1e-6);
  const auto image = read_depth(
      {kStart_ns + 100'000'000, back / "depth" / fmt::format("{}.png", kStart_ns + 100'000'000)}, info->camera);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->units[0], 10'000);
  EXPECT_EQ(image->units[1], 10'005);
  EXPECT_EQ(image->units[2], 0);
  EXPECT_EQ(image->units[3], 0) << "16 m do not fit";
  const auto truth = read_tum(back / "groundtruth.tum");
  ASSERT_EQ(truth->size(), 1U);
  EXPECT_EQ(truth->front().stamp_ns, kStart_ns);
  EXPECT_TRUE(truth->front().T_map_sensor.translation().isApprox(Eigen::Vector3d(1, 2, 3)));
}

TEST_F(TumFolder, WhatIsWrongIsNamed) {
  EXPECT_THAT(error_of("# nothing\n"), HasSubstr("names no image"));
  EXPECT_THAT(error_of("1.5 depth/a.png extra\n"), HasSubstr("depth.txt: line 1"));
  EXPECT_THAT(error_of("#\n1.5 ../../secret.png\n"), HasSubstr("depth.txt: line 2"));
  EXPECT_THAT(error_of("1.5 /etc/passwd\n"), HasSubstr("line 1"));
  EXPECT_THAT(error_of("2 depth/a.png\n1 depth/b.png\n"), HasSubstr("does not rise"));
  EXPECT_THAT(error_of("1 depth/absent.png\n"), HasSubstr("no such file"));
  folder_.put("tum/depth/8bit.png", "no image");
  EXPECT_THAT(error_of("1 depth/8bit.png\n"), HasSubstr("no sound PNG"));
}

TEST_F(TumFolder, AStopEndsIt) {
  const DeviceRecording device = recorded();
  ASSERT_TRUE(device_to_tum(device, folder_.path() / "tum"));
  const auto stopped = [] { return true; };
  EXPECT_THAT(
      tum_to_device(folder_.path() / "tum", folder_.path() / "rec", device.info, stopped).error().message,
      HasSubstr("stopped by a signal"));
  EXPECT_THAT(device_to_tum(device, folder_.path() / "tum2", stopped).error().message,
              HasSubstr("stopped by a signal"));
}

}  // namespace
}  // namespace liloc
