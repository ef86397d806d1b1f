// A recording that cannot be replayed is refused in one line that names the file, before anything is created.
#include <gmock/gmock.h>
#include <png.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "proto-tests/replay/prepare.hpp"
#include "proto-tests/replay/replay.hpp"
#include "proto-tests/replay/tests/small_recording.hpp"
#include "proto-tests/replay/tests/temp_folder.hpp"

namespace liloc::replay {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

void replace_in(const fs::path& file, const std::string& from, const std::string& to) {
  std::string text = text_of(file);
  const auto at = text.find(from);
  ASSERT_NE(at, std::string::npos) << file << " has no " << from;
  text.replace(at, from.size(), to);
  ASSERT_TRUE(write_file(file, text));
}

/// The value of the first `"name": value` in a JSON file.
void set_field(const fs::path& file, const std::string& name, const std::string& value) {
  std::string text = text_of(file);
  const auto key = text.find("\"" + name + "\"");
  ASSERT_NE(key, std::string::npos) << file << " has no " << name;
  const auto start = text.find(':', key) + 1;
  const bool list = text.find('[', start) < text.find(',', start);
  const auto end = list ? text.find(']', start) + 1 : text.find_first_of(",}\n", start);
  ASSERT_TRUE(write_file(file, text.substr(0, start) + value + text.substr(end)));
}

void write_8bit_png(const fs::path& file, int width, int height) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_GRAY;
  const std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width * height), 7);
  ASSERT_TRUE(png_image_write_to_file(&image, file.c_str(), 0, pixels.data(), 0, nullptr));
}

class BadInput : public testing::Test {
 protected:
  void SetUp() override {
    write_small_recording(root_);
    options_.recording = root_;
    options_.out = folder_.path() / "out";
    options_.lockstep = true;
  }

  /// The replay is refused as bad input, in one line with all of `parts`, and OUT does not appear.
  void expect_refused(const std::vector<std::string>& parts) {
    const auto report = replay(options_);
    ASSERT_FALSE(report) << "was replayed";
    EXPECT_TRUE(report.error().bad_input);
    const std::string& message = report.error().error.message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& part : parts) EXPECT_THAT(message, HasSubstr(part));
    EXPECT_FALSE(fs::exists(options_.out));
  }

  TempFolder folder_;
  fs::path root_ = folder_.path() / "rec";
  fs::path site_ = root_ / "site.json", device_ = root_ / "devices/device0";
  fs::path ceiling_frame_ = root_ / fmt::format("global/ceiling0/depth/{}.png", kSmallStart_ns);
  fs::path device_frame_ = device_ / fmt::format("depth/{}.png", kSmallStart_ns);
  ReplayOptions options_;
};

TEST_F(BadInput, ASoundRecordingOpens) {
  const auto recording = open_for_replay(options_);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->devices.size(), 1u);
  EXPECT_FALSE(fs::exists(options_.out));
}

TEST_F(BadInput, NoRecording) {
  options_.recording = folder_.path() / "nowhere";
  expect_refused({"nowhere"});
}
TEST_F(BadInput, NoSiteFile) {
  fs::remove(site_);
  expect_refused({"site.json"});
}
TEST_F(BadInput, SiteIsNoJson) {
  ASSERT_TRUE(write_file(site_, "{ \"world_frame\": "));
  expect_refused({"site.json"});
}
TEST_F(BadInput, SiteCannotBeRead) {
  if (geteuid() == 0) {
    // Root reads everything; a folder in the file's place cannot be read by anyone.
    fs::remove(site_);
    fs::create_directory(site_);
  } else {
    ASSERT_EQ(chmod(site_.c_str(), 0), 0);
  }
  expect_refused({"site.json"});
}
TEST_F(BadInput, SiteWithZeroIntrinsics) {
  set_field(site_, "fx", " 0");
  expect_refused({"site.json", "fx"});
}
TEST_F(BadInput, SiteWithARotationThatIsNotOfUnitLength) {
  set_field(site_, "rotation_xyzw", " [0, 0, 0, 2]");
  expect_refused({"site.json", "T_map_sensor"});
}
TEST_F(BadInput, NoDeviceFile) {
  fs::remove(device_ / "device.json");
  expect_refused({"device.json"});
}
TEST_F(BadInput, DeviceIsNoJson) {
  ASSERT_TRUE(write_file(device_ / "device.json", "[]"));
  expect_refused({"device.json"});
}
TEST_F(BadInput, DeviceWithZeroIntrinsics) {
  set_field(device_ / "device.json", "fy", " 0");
  expect_refused({"device.json", "fy"});
}
TEST_F(BadInput, ImageOfEightBits) {
  write_8bit_png(ceiling_frame_, 80, 60);
  expect_refused({ceiling_frame_.filename().string(), "8 bits", "16-bit"});
}
TEST_F(BadInput, ImageOfAnotherSize) {
  DepthImage image{kSmallStart_ns, 40, 30, std::vector<std::uint16_t>(1200, 2000)};
  ASSERT_TRUE(write_depth(device_ / "depth", image));
  expect_refused({device_frame_.filename().string(), "40x30", "80x60"});
}
TEST_F(BadInput, ImageWhoseNameIsNoStamp) {
  fs::rename(device_frame_, device_ / "depth/first.png");
  expect_refused({"first.png"});
}
TEST_F(BadInput, ImuStampsOutOfOrder) {
  replace_in(device_ / "imu.csv", std::to_string(kSmallStart_ns),
             std::to_string(kSmallStart_ns + from_ms(500)));
  expect_refused({"imu.csv"});
}
TEST_F(BadInput, ImuIsNoTable) {
  ASSERT_TRUE(write_file(device_ / "imu.csv", "1,2,three\n"));
  expect_refused({"imu.csv"});
}
TEST_F(BadInput, GroundTruthDoesNotFitTheFrames) {
  fs::remove(device_frame_);
  expect_refused({"groundtruth.tum", "2 poses for 1 depth frames"});
}
TEST_F(BadInput, UnknownDevice) {
  options_.devices = {"device7"};
  expect_refused({"device7", "device0"});
}
TEST_F(BadInput, InertialWithoutImu) {
  fs::remove(device_ / "imu.csv");
  options_.local = "inertial";
  expect_refused({"inertial", "imu.csv"});
}
TEST_F(BadInput, LearnedFeaturesNeedWeights) {
  options_.features = "learned";
  expect_refused({"--features", "--weights", "convert_fcgf.py"});
  options_.weights = root_ / "none.safetensors";
  expect_refused({"--weights", "none.safetensors", "convert_fcgf.py"});
  options_.features = "fpfh";
  expect_refused({"--weights", "--features learned"});
  options_.weights.clear();
  options_.features = "magic";
  expect_refused({"--features", "magic"});
}
TEST_F(BadInput, WrongAnswersNeedTheTruth) {
  options_.save_answers = "kept:wrong";
  options_.lockstep = true;
  fs::remove(device_ / "groundtruth.tum");
  expect_refused({"groundtruth.tum", "DIR:all"});
  options_.lockstep = false;
  expect_refused({"--save-answers", "--lockstep"});
}
TEST_F(BadInput, OptionsOutOfRange) {
  options_.voxel_m = 0;
  expect_refused({"--voxel"});
  options_.voxel_m = 0.05;
  options_.method = "magic";
  expect_refused({"magic"});
}

TEST_F(BadInput, AFolderOfSomeoneElseIsLeftAlone) {
  fs::create_directories(options_.out);
  ASSERT_TRUE(write_file(options_.out / "thesis.txt", "years of work"));
  const auto report = replay(options_);
  ASSERT_FALSE(report);
  EXPECT_TRUE(report.error().bad_input);
  EXPECT_THAT(report.error().error.message, HasSubstr("thesis.txt"));
  EXPECT_EQ(text_of(options_.out / "thesis.txt"), "years of work");
  EXPECT_FALSE(fs::exists(options_.out / "report.json"));
}

TEST_F(BadInput, OneDamagedFrameIsSkippedCountedAndReported) {
  const std::string bytes = text_of(device_frame_);
  ASSERT_TRUE(write_file(device_frame_, bytes.substr(0, bytes.size() / 2)));
  const auto report = replay(options_);
  ASSERT_TRUE(report) << report.error().error.message;
  ASSERT_EQ(report->run.skipped.size(), 1u);
  EXPECT_THAT(report->run.skipped[0], HasSubstr(device_frame_.filename().string()));
  EXPECT_THAT(to_table(*report), HasSubstr("1 frames skipped"));
  EXPECT_THAT(text_of(options_.out / "report.json"), HasSubstr(device_frame_.filename().string()));
  EXPECT_TRUE(fs::exists(options_.out / "device0/local.csv"));
}

TEST_F(BadInput, AnEarlierReplayIsReplaced) {
  ASSERT_TRUE(replay(options_));
  ASSERT_TRUE(write_file(options_.out / "device9/online.tum", "0 0 0 0 0 0 0 1\n"));
  const auto again = replay(options_);
  ASSERT_TRUE(again) << again.error().error.message;
  EXPECT_FALSE(fs::exists(options_.out / "device9"));
}

}  // namespace
}  // namespace liloc::replay
