// liloc convert, and liloc replay of a bag, as a user runs them.
#include "common/recording/bags/tests/written.hpp"
#include "common/recording/files.hpp"
#include "common/recording/writer.hpp"
#include "proto-tests/toolbox/tests/program_test.hpp"

namespace liloc::toolbox {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;
namespace written = bags::written;

class Convert : public ProgramTest {
 protected:
  Convert() {
    EXPECT_EQ(
        liloc("sim " + path("rec") + " --lidars 1 --seconds 2 --image-width 160 --image-height 120").exit_code,
        0);
  }
  /// The recording as a bag.
  [[nodiscard]] std::string bag() const {
    const auto recording = open_recording(path("rec"));
    std::string records = written::channel("/ceiling0/depth/image", "sensor_msgs/msg/Image", 1) +
                          written::channel("/device0/depth/image", "sensor_msgs/msg/Image", 2) +
                          written::channel("/imu", "sensor_msgs/msg/Imu", 3);
    const auto put = [&](const std::vector<DepthFile>& files, const Camera& camera, std::uint16_t channel) {
      for (const DepthFile& file : files) {
        const auto image = read_depth(file, camera);
        std::string data(2 * image->units.size(), '\0');
        std::memcpy(data.data(), image->units.data(), data.size());
        const auto width = static_cast<std::uint32_t>(camera.width),
                   height = static_cast<std::uint32_t>(camera.height);
        records += written::message(written::image("16UC1", width, height, data, file.stamp_ns), channel);
      }
    };
    put(recording->lidars[0].depth, recording->lidars[0].info.camera, 1);
    put(recording->devices[0].depth, recording->devices[0].info.camera, 2);
    const auto values = [](const Eigen::Vector3d& v) { return std::array{v.x(), v.y(), v.z()}; };
    for (const ImuSample& s : recording->devices[0].imu)
      records += written::message(
          written::imu(values(s.angular_velocity_rad_s), values(s.specific_force_m_s2), s.stamp_ns), 3);
    const std::string file = path("bag.mcap");
    EXPECT_TRUE(write_file(file, written::mcap(records)));
    return file;
  }
  [[nodiscard]] std::string topics() const {
    return " --lidar ceiling0=/ceiling0/depth/image --device device0=/device0/depth/image --imu device0=/imu "
           "--site " +
           path("rec/site.json") + " --device-file device0=" + path("rec/devices/device0/device.json") +
           " --truth device0=" + path("rec/devices/device0/groundtruth.tum");
  }
};

TEST_F(Convert, ABagBecomesTheRecordingItWasMadeOf) {
  const Outcome done = liloc("convert" + topics() + " " + bag() + " " + path("again"));
  ASSERT_EQ(done.exit_code, 0) << done.out;
  EXPECT_THAT(done.out, HasSubstr("/device0/depth/image: 30\n"));
  const auto before = open_recording(path("rec")), after = open_recording(path("again"));
  ASSERT_TRUE(after) << after.error().message;
  ASSERT_EQ(after->devices[0].depth.size(), before->devices[0].depth.size());
  for (std::size_t i = 0; i < before->devices[0].depth.size(); ++i) {
    ASSERT_EQ(after->devices[0].depth[i].stamp_ns, before->devices[0].depth[i].stamp_ns);
    EXPECT_EQ(read_depth(after->devices[0].depth[i], after->devices[0].info.camera)->units,
              read_depth(before->devices[0].depth[i], before->devices[0].info.camera)->units);
  }
}

TEST_F(Convert, AReplayOfTheBagIsTheReplayOfTheRecording) {
  const Outcome of_bag = liloc("replay " + bag() + topics() + " --lockstep --out " + path("of_bag"));
  const Outcome of_recording = liloc("replay " + path("rec") + " --lockstep --out " + path("of_rec"));
  ASSERT_EQ(of_bag.exit_code, of_recording.exit_code) << of_bag.out << of_recording.out;
  EXPECT_EQ(*read_file(path("of_bag/device0/online.tum"), 1 << 20),
            *read_file(path("of_rec/device0/online.tum"), 1 << 20));
  EXPECT_THAT(of_bag.out, HasSubstr("spots                  3 asked, 3 verified"));
  EXPECT_THAT(liloc("replay " + path("rec") + topics() + " --lockstep --out " + path("no")).out,
              HasSubstr("is no bag; leave out the options of bags"));
}

TEST_F(Convert, TumThereAndBack) {
  ASSERT_EQ(liloc("convert " + path("rec") + " " + path("tum") + " --to tum").exit_code, 0);
  const Camera camera = read_device(path("rec/devices/device0/device.json"))->camera;
  const Outcome done =
      liloc(fmt::format("convert {} {} --device device0 --camera {},{},{},{},{},{}", path("tum/device0"),
                        path("back"), camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy));
  ASSERT_EQ(done.exit_code, 0) << done.out;
  EXPECT_THAT(done.out, HasSubstr("device0: 30 frames"));
  const auto device = read_device(path("back/devices/device0/device.json"));
  ASSERT_TRUE(device) << device.error().message;
  const DepthFile first = open_recording(path("rec"))->devices[0].depth[0];
  const auto before = read_depth(first, camera);
  const auto after = read_depth(
      {first.stamp_ns, fs::path(path("back/devices/device0/depth")) / first.path.filename()}, device->camera);
  ASSERT_TRUE(after) << after.error().message;
  for (std::size_t i = 0; i < before->units.size(); ++i)
    ASSERT_NEAR(after->units[i] * 0.0002, before->units[i] * camera.depth_scale_m, 0.0001 + 1e-9);
}

TEST_F(Convert, AFullDiskIsToldAndLeavesNothing) {
  const Camera camera = read_device(path("rec/devices/device0/device.json"))->camera;
  ASSERT_EQ(liloc("convert " + path("rec") + " " + path("tum") + " --to tum").exit_code, 0);
  const std::string of_bag = topics() + " " + bag();
  for (const std::string& arguments :
       {"convert" + of_bag + " " + path("disk/new"),
        "convert " + path("rec") + " " + path("disk/new") + " --to tum",
        fmt::format("convert {} {} --device device0 --camera {},{},{},{},{},{}", path("tum/device0"),
                    path("disk/new"), camera.width, camera.height, camera.fx, camera.fy, camera.cx,
                    camera.cy)}) {
    const Outcome full = on_full_disk(200, arguments);
    expect_told_as_full(full);
    EXPECT_THAT(full.out, HasSubstr("/depth/")) << "of a frame";
    EXPECT_TRUE(fs::is_empty(path("left"))) << arguments;
    fs::remove_all(path("left"));
  }
  ::setenv("TMPDIR", path("disk").c_str(), 1);
  const Outcome replayed = on_full_disk(200, "replay" + of_bag + " --lockstep --out " + path("out"));
  ::unsetenv("TMPDIR");
  expect_told_as_full(replayed);
  EXPECT_TRUE(fs::is_empty(path("left")));
}

TEST_F(Convert, BadUsageIsOneLineAndLeavesNothing) {
  const auto wrong = [&](const std::string& arguments, const std::string& part) {
    expect_refused("convert " + arguments, part, "new");
  };
  wrong(path("rec"), "OUT");
  wrong(path("rec") + " " + path("new"), "holds no .mcap or .db3");
  wrong(bag() + " " + path("new") + " --lidar ceiling0", "'ceiling0' is not ID=VALUE");
  wrong(bag() + " " + path("new") + " --lidar ceiling0=/ceiling0/depth/image", "camera_info");
  wrong(bag() + " " + path("rec") + topics(), "is there already");
  wrong(bag() + " " + path("new") + " --to euroc", "--to");
  const std::string sensors = bag() + " " + path("new") + " --lidar ceiling0=/ceiling0/depth/image";
  wrong(sensors + " --site " + path("rec/site.json") + " --world hall", "--world: the file of --site names it");
  wrong(sensors + " --still-seconds 2", "--still-seconds: there is no --device");
  wrong(sensors + " --camera 80,60,60,60,39.5,29.5", "--camera: is of a TUM sequence");
  wrong(path("rec") + " " + path("new") + " --to tum --device device0", "--to tum: takes all devices");
  for (const char* of_bags : {" --world hall", " --still-seconds 2"})
    expect_refused("replay " + path("rec") + " --lockstep --out " + path("new") + of_bags, "is no bag", "new");
  expect_refused("replay " + path("rec") + " --lockstep --clock-ahead-ms 50 --out " + path("new"),
                 "--clock-ahead-ms: does nothing with --lockstep", "new");
  ASSERT_TRUE(write_file(path("seq/depth.txt"), "1 depth/absent.png\n"));
  wrong(path("seq") + " " + path("new"), "give --device ID and --camera");
  wrong(path("seq") + " " + path("new") + " --device a", "--camera: missing");
  wrong(path("seq") + " " + path("new") + " --device a --camera 80,60,60,60,39.5,29.5", "no such file");
}

}  // namespace
}  // namespace liloc::toolbox
