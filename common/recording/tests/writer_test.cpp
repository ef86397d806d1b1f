#include "common/recording/writer.hpp"

#include <gmock/gmock.h>

#include <random>

#include "common/recording/imu_table.hpp"
#include "common/recording/tests/temporary_folder.hpp"

namespace liloc {
namespace {

constexpr StampNs kStart = 1'700'000'000'123'456'789;

Pose random_pose(std::mt19937& rng) {
  std::normal_distribution<double> n;
  Pose T = Pose::Identity();
  T.linear() = so3_exp({n(rng), n(rng), n(rng)});
  T.translation() = Eigen::Vector3d(n(rng), n(rng), n(rng));
  return T;
}

Camera office_camera() {
  return {64, 48, 45.7, 46.1, 31.5, 23.5, 0.00025};
}

DepthImage noise_image(std::mt19937& rng, const Camera& camera, StampNs stamp_ns) {
  DepthImage image{stamp_ns, camera.width, camera.height, {}};
  for (int i = 0; i < camera.width * camera.height; ++i)
    image.units.push_back(static_cast<std::uint16_t>(rng()));
  return image;
}

TEST(RoundTrip, SiteKeepsEveryField) {
  const TemporaryFolder folder;
  std::mt19937 rng(11);
  Site site{"hall",
            {{"ceiling0", office_camera(), 6, random_pose(rng)},
             {"ceiling-1", office_camera(), 7.5, random_pose(rng)}}};
  ASSERT_TRUE(write_site(folder.path() / "site.json", site));
  const auto read = read_site(folder.path() / "site.json");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->world_frame, "hall");
  ASSERT_EQ(read->global_lidars.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto &a = site.global_lidars[i], &b = read->global_lidars[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.rate_hz, b.rate_hz);
    EXPECT_EQ(a.camera.fx, b.camera.fx);
    EXPECT_EQ(a.camera.cy, b.camera.cy);
    EXPECT_EQ(a.camera.depth_scale_m, b.camera.depth_scale_m);
    EXPECT_TRUE(a.T_map_sensor.isApprox(b.T_map_sensor, 1e-12));
  }
}

TEST(RoundTrip, DeviceKeepsOptionalFieldsOnlyWhereGiven) {
  const TemporaryFolder folder;
  std::mt19937 rng(12);
  DeviceInfo plain{"phone", office_camera(), 15, 3, std::nullopt, std::nullopt};
  DeviceInfo inertial = plain;
  inertial.imu_rate_hz = 200;
  inertial.T_imu_sensor = random_pose(rng);
  for (const auto& device : {plain, inertial}) {
    ASSERT_TRUE(write_device(folder.path() / "device.json", device));
    const auto read = read_device(folder.path() / "device.json");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->id, device.id);
    EXPECT_EQ(read->still_seconds, device.still_seconds);
    EXPECT_EQ(read->imu_rate_hz, device.imu_rate_hz);
    ASSERT_EQ(read->T_imu_sensor.has_value(), device.T_imu_sensor.has_value());
    EXPECT_TRUE(!device.T_imu_sensor || read->T_imu_sensor->isApprox(*device.T_imu_sensor, 1e-12));
  }
}

TEST(RoundTrip, DepthIsExact) {
  const TemporaryFolder folder;
  std::mt19937 rng(13);
  DepthImage image = noise_image(rng, office_camera(), kStart);
  image.units[7] = 65535;
  ASSERT_TRUE(write_depth(folder.path() / "depth", image));
  image.units[7] = 0;  // the largest value is no return
  const auto read =
      read_depth({kStart, folder.path() / "depth" / (std::to_string(kStart) + ".png")}, office_camera());
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->stamp_ns, kStart);
  EXPECT_EQ(read->units, image.units);
}

TEST(RoundTrip, ImuAndTumKeepNanoseconds) {
  const TemporaryFolder folder;
  std::mt19937 rng(14);
  std::vector<ImuSample> samples;
  std::vector<StampedPose> poses;
  for (StampNs i = 0; i < 50; ++i) {
    const Pose T = random_pose(rng);
    samples.push_back({kStart + i * 5'000'001, T.translation(), 9.8 * T.linear().col(2)});
    poses.push_back({kStart + i * 66'666'667, T});
  }
  ASSERT_TRUE(write_imu(folder.path() / "imu.csv", samples));
  ASSERT_TRUE(write_tum(folder.path() / "truth.tum", poses));
  const auto imu = read_imu(folder.path() / "imu.csv");
  const auto tum = read_tum(folder.path() / "truth.tum");
  ASSERT_TRUE(imu) << imu.error().message;
  ASSERT_TRUE(tum) << tum.error().message;
  ASSERT_EQ(imu->size(), samples.size());
  ASSERT_EQ(tum->size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ((*imu)[i].stamp_ns, samples[i].stamp_ns);
    EXPECT_NEAR(((*imu)[i].specific_force_m_s2 - samples[i].specific_force_m_s2).norm(), 0, 2e-9);
    EXPECT_EQ((*tum)[i].stamp_ns, poses[i].stamp_ns);
    EXPECT_LT(angle_between_rad((*tum)[i].T_map_sensor, poses[i].T_map_sensor), 1e-8);
  }
}

TEST(ImuTable, EachRowCanBeReadBeforeTheTableIsClosed) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "imu.csv";
  ImuTable table;
  ASSERT_TRUE(table.open(file));
  for (StampNs i = 0; i < 300; ++i) {  // more than a stream's buffer holds
    table.add({kStart + i * 5'000'000, {0.1, 0.2, 0.3}, {0, 0, 9.81}});
    const auto imu = read_imu(file);
    ASSERT_TRUE(imu) << imu.error().message;
    ASSERT_EQ(imu->size(), static_cast<std::size_t>(i) + 1) << "a killed recorder leaves what it had";
  }
}

TEST(RoundTrip, WholeRecordingOpensSortedByStamp) {
  const TemporaryFolder folder;
  const auto& root = folder.path();
  std::mt19937 rng(15);
  const Camera camera = office_camera();
  ASSERT_TRUE(write_site(root / "site.json", {"map", {{"c0", camera, 6, random_pose(rng)}}}));
  ASSERT_TRUE(write_device(root / "devices/d0/device.json", {"d0", camera, 15, 3, {}, {}}));
  for (const StampNs stamp :
       {StampNs{100}, StampNs{20}, StampNs{3}}) {  // by name 100 comes first, by stamp last
    ASSERT_TRUE(write_depth(root / "global/c0/depth", noise_image(rng, camera, stamp)));
    ASSERT_TRUE(write_depth(root / "devices/d0/depth", noise_image(rng, camera, stamp)));
  }
  folder.put("devices/d0/depth/.7.png.part", "unfinished");
  const auto recording = open_recording(root);
  ASSERT_TRUE(recording) << recording.error().message;
  ASSERT_EQ(recording->lidars.size(), 1u);
  ASSERT_EQ(recording->devices.size(), 1u);
  ASSERT_EQ(recording->devices[0].depth.size(), 3u);
  EXPECT_EQ(recording->devices[0].depth[0].stamp_ns, 3);
  EXPECT_EQ(recording->lidars[0].depth[2].stamp_ns, 100);
  const auto truth = read_ground_truth(recording->devices[0]);
  ASSERT_TRUE(truth);
  EXPECT_TRUE(truth->empty());
}

TEST(Writer, LeavesNothingHalfWritten) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "site.json/in_the_way");
  const auto written = write_site(folder.path() / "site.json", {});
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, testing::HasSubstr("site.json"));
  int entries = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++entries;
  EXPECT_EQ(entries, 1) << "the unfinished file must be gone";
}

TEST(Writer, RefusesAnImageWhoseDataDoNotFitItsSize) {
  const TemporaryFolder folder;
  EXPECT_FALSE(write_depth(folder.path(), {1, 4, 4, std::vector<std::uint16_t>(15)}));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace liloc
