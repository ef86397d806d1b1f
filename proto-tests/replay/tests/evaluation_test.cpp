// The judge's definitions, on a recording small enough to be worked out by hand: a wall 2 m ahead of a device,
// seen by a ceiling LiDAR from the very same place.
#include "proto-tests/replay/evaluation.hpp"

#include <gmock/gmock.h>

#include "proto-tests/replay/tests/small_recording.hpp"
#include "proto-tests/replay/tests/temp_folder.hpp"
#include "proto-tests/replay/truth.hpp"

namespace liloc::replay {
namespace {

using testing::DoubleNear;
using testing::Optional;

constexpr StampNs kStart_ns = kSmallStart_ns, kStep_ns = from_ms(100);
constexpr int kFrames = 5;

/// The device moves 0.1 m to the right per frame.
Pose true_pose(int frame) {
  return Pose(Eigen::Translation3d(0.1 * frame, 0, 0));
}

class Evaluation : public testing::Test {
 protected:
  void SetUp() override {
    recording_.root = folder_.path();
    recording_.lidars.push_back({{"ceiling0", small_camera(), 10, Pose::Identity()}, {}});
    device_.info = {"device0", small_camera(), 10, 0, {}, {}};
    device_.folder = folder_.path() / "devices/device0";
    std::vector<StampedPose> truth;
    for (int i = 0; i < kFrames; ++i) {
      const StampNs stamp_ns = kStart_ns + i * kStep_ns;
      add_frame(recording_.lidars[0].depth, folder_.path() / "global/ceiling0/depth",
                wall_image(stamp_ns + from_ms(30), 2000));
      add_frame(device_.depth, device_.folder / "depth", wall_image(stamp_ns, 2000));
      truth.push_back({stamp_ns, true_pose(i)});
    }
    ASSERT_TRUE(write_tum(device_.folder / "groundtruth.tum", truth));
    recording_.devices.push_back(device_);
    std::filesystem::create_directories(out_);
  }

  static void add_frame(std::vector<DepthFile>& files, const std::filesystem::path& folder,
                        const DepthImage& image) {
    ASSERT_TRUE(write_depth(folder, image));
    files.push_back({image.stamp_ns, folder / fmt::format("{}.png", image.stamp_ns)});
  }

  void write_track(const std::string& name, const std::vector<StampedPose>& poses) {
    ASSERT_TRUE(write_tum(out_ / name, poses));
  }
  void write_text(const std::string& name, const std::string& text) {
    ASSERT_TRUE(write_file(out_ / name, text));
  }

  DeviceScore score() {
    const auto score = evaluate(recording_, device_, out_);
    EXPECT_TRUE(score) << score.error().message;
    return score ? *score : DeviceScore{};
  }

  TempFolder folder_;
  Recording recording_;
  DeviceRecording device_;
  std::filesystem::path out_ = folder_.path() / "out";
};

TEST_F(Evaluation, TrackErrorsAreMeansOverTheFramesThatHaveAPose) {
  // Frame 1 is 0.1 m off, frame 2 0.4 m, frame 3 turned by 20 deg; a pose far from any frame's stamp is
  // ignored.
  std::vector<StampedPose> poses;
  poses.push_back({kStart_ns + kStep_ns, Pose(Eigen::Translation3d(0.2, 0, 0))});
  poses.push_back({kStart_ns + 2 * kStep_ns, Pose(Eigen::Translation3d(0.2, 0.4, 0))});
  poses.push_back({kStart_ns + 3 * kStep_ns,
                   true_pose(3) * Pose(Eigen::AngleAxisd(radians(20), Eigen::Vector3d::UnitZ()))});
  poses.push_back({kStart_ns + from_ms(350), true_pose(0)});
  write_track("online.tum", poses);
  const TrackScore track = score().online;
  EXPECT_DOUBLE_EQ(track.coverage, 3.0 / kFrames);
  EXPECT_THAT(track.mean_trans_m, Optional(DoubleNear(0.5 / 3, 1e-6)));
  EXPECT_THAT(track.median_trans_m, Optional(DoubleNear(0.1, 1e-6)));
  EXPECT_THAT(track.mean_rot_deg, Optional(DoubleNear(20.0 / 3, 1e-4)));
  EXPECT_THAT(track.frames_over_10deg_03m, Optional(DoubleNear(2.0 / 3, 1e-9)));
  EXPECT_TRUE(track.correct);
  EXPECT_THAT(score().first_pose_ms, Optional(DoubleNear(100, 1e-6)));
}

TEST_F(Evaluation, AnEmptyRunHasNoErrorsAndIsNotCorrect) {
  const DeviceScore empty = score();
  EXPECT_EQ(empty.online.coverage, 0);
  EXPECT_FALSE(empty.online.mean_trans_m.has_value());
  EXPECT_FALSE(empty.online.correct);
  EXPECT_EQ(empty.spots.n, 0u);
  EXPECT_FALSE(empty.local.has_value());
}

TEST_F(Evaluation, SpotsCountWithOverlapAndVerifiedOnesMustNotBeWrong) {
  write_text("spots.csv",
             fmt::format("stamp_ns,status,verified,reason,tx,ty,tz,qx,qy,qz,qw,latency_ms\n"
                         "{},verified,1,confirmed,0.02,0,0,0,0,0,1,10\n"   // 2 cm off: strict
                         "{},verified,1,confirmed,0.3,0,0,0,0,0,1,20\n"    // 0.2 m off: loose
                         "{},verified,1,confirmed,0.2,0.5,0,0,0,0,1,30\n"  // 0.5 m off: a verified wrong one
                         "{},refused,0,not_found,,,,,,,,40\n",             // no answer
                         kStart_ns, kStart_ns + kStep_ns, kStart_ns + 2 * kStep_ns, kStart_ns + 3 * kStep_ns));
  const SpotScore spots = score().spots;
  EXPECT_EQ(spots.n, 4u);
  EXPECT_EQ(spots.n_overlap, 4u);
  EXPECT_THAT(spots.loose, Optional(DoubleNear(0.5, 1e-9)));
  EXPECT_THAT(spots.strict, Optional(DoubleNear(0.25, 1e-9)));
  EXPECT_EQ(spots.verified, 3u);
  EXPECT_EQ(spots.verified_wrong, 1u);
  EXPECT_THAT(spots.latency_ms_median, Optional(DoubleNear(25, 1e-9)));
  EXPECT_THAT(spots.latency_ms_p99, Optional(DoubleNear(39.7, 1e-9)));
  EXPECT_EQ(score().reasons.at("confirmed"), 3u);
}

TEST_F(Evaluation, DriftIsTheErrorOfTheWholeWay) {
  // Odometry in its own frame, 5 % long: 0.42 m instead of 0.4 m.
  std::string text = "stamp_ns,informative,method,converged,latency_ms,tx,ty,tz,qx,qy,qz,qw\n";
  for (int i = 0; i < kFrames; ++i)
    text += fmt::format("{},1,icp,1,{},{},7,0,0,0,0,1\n", kStart_ns + i * kStep_ns, i + 1, 0.105 * i);
  write_text("local.csv", text);
  const auto local = score().local;
  ASSERT_TRUE(local);
  EXPECT_NEAR(local->path_m, 0.4, 1e-6);
  EXPECT_NEAR(local->end_pct_of_path, 5, 1e-3);
  EXPECT_EQ(local->pairs, kFrames - 1u);
  EXPECT_THAT(local->ok_3deg_01m, Optional(1.0));
  EXPECT_THAT(local->median_trans_m, Optional(DoubleNear(0.005, 1e-6)));
  EXPECT_THAT(local->latency_ms_median, Optional(DoubleNear(3, 1e-9)));
}

TEST_F(Evaluation, OverlapIsTheShareThatTheCeilingSees) {
  EXPECT_DOUBLE_EQ(overlap_at_truth(recording_, device_, device_.depth[0], true_pose(0)), 1.0);
  // Half the wall's width further right, half of what the device sees is unseen by the ceiling.
  const double width_m = 2.0 * 80 / 60;
  EXPECT_NEAR(
      overlap_at_truth(recording_, device_, device_.depth[0], Pose(Eigen::Translation3d(width_m / 2, 0, 0))),
      0.5, 0.05);
  EXPECT_DOUBLE_EQ(
      overlap_at_truth(recording_, device_, device_.depth[0], Pose(Eigen::Translation3d(0, 0, 0.2))), 0.0);
  DepthFile late = device_.depth[0];
  late.stamp_ns += from_seconds(10);  // no ceiling frame within 100 ms
  EXPECT_DOUBLE_EQ(overlap_at_truth(recording_, device_, late, true_pose(0)), 0.0);
}

TEST_F(Evaluation, TruthMustFitTheFrames) {
  device_.depth.pop_back();
  const auto score = evaluate(recording_, device_, out_);
  ASSERT_FALSE(score);
  EXPECT_THAT(score.error().message, testing::HasSubstr("5 poses for 4 depth frames"));
}

TEST(Percentile, IsLinearBetweenNeighbours) {
  EXPECT_EQ(percentile({}, 0.5), std::nullopt);
  EXPECT_THAT(percentile({3, 1, 2}, 0.5), Optional(2.0));
  EXPECT_THAT(percentile({0, 10}, 0.99), Optional(DoubleNear(9.9, 1e-12)));
}

}  // namespace
}  // namespace liloc::replay
