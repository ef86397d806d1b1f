#include "client/engine/pose_doubt.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

constexpr StampNs kFrameNs = from_ms(100);

/// A device that goes along x by 0.1 m a frame; every eighth frame becomes a request's.
class Walk {
 public:
  void frames(int count, bool contradicted = false, bool converged = true, bool misfit = false) {
    for (int i = 0; i < count; ++i) {
      ++frame;
      step.converged = converged;
      step.T_odom_sensor.translation().x() = 0.1 * frame;
      ++since_asked_;
      doubt.travelled(stamp(frame), step, {0.001 * since_asked_, 0.002 * since_asked_}, {contradicted, misfit});
      if (frame % 8 != 0) continue;
      doubt.asked(stamp(frame));
      since_asked_ = 0;
    }
  }
  static StampNs stamp(int frame) { return frame * kFrameNs; }
  void answer(int asked_frame) {
    SpotReply reply;
    reply.stamp_ns = stamp(asked_frame);
    reply.T_map_odom = Pose(Eigen::Translation3d(5, 0, 0));
    reply.covariance = 1e-4 * Matrix6d::Identity();
    doubt.verified(reply);
  }
  PoseDoubt doubt;
  OdometryStep step;
  int frame = 0;

 private:
  int since_asked_ = 0;
};

TEST(PoseDoubt, BeforeAVerifiedAnswerThereIsNone) {
  Walk walk;
  walk.frames(20);
  EXPECT_FALSE(walk.doubt.estimate());
}

TEST(PoseDoubt, IsTheAnswersAndWhatOdometryErredSinceItsFrame) {
  Walk walk;
  walk.frames(20);
  walk.answer(8);
  const auto estimate = walk.doubt.estimate();
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(estimate->T_map_sensor.translation().x(), 5 + 0.1 * 20, 1e-9);
  const double along_m2 = 1e-4 + 0.016 * 0.016 + 0.008 * 0.008;
  EXPECT_NEAR(estimate->covariance(3, 3), along_m2, 1e-9);
  EXPECT_GT(estimate->covariance(4, 4), along_m2 + 1e-4);  // an error of the heading shows after the way gone
}

TEST(PoseDoubt, AnAnswerInTimeIsTheSameAsOneThatComesLate) {
  Walk early, late;
  early.frames(8);
  early.answer(8);
  early.frames(30);
  late.frames(38);
  late.answer(8);
  EXPECT_LT((early.doubt.estimate()->covariance - late.doubt.estimate()->covariance).norm(), 1e-12);
}

TEST(PoseDoubt, GrowsUntilTheNextAnswer) {
  Walk walk;
  walk.frames(8);
  walk.answer(8);
  double before = 0;
  for (int i = 0; i < 40; ++i) {
    walk.frames(1);
    EXPECT_GT(walk.doubt.estimate()->sd_m(), before) << i;
    before = walk.doubt.estimate()->sd_m();
  }
  walk.answer(48);
  EXPECT_NEAR(walk.doubt.estimate()->sd_m(), 0.01, 1e-9);
}

TEST(PoseDoubt, ABreakOfTheOdometryCostsWhatTheDeviceMayHaveGone) {
  Walk walk;
  walk.frames(8);
  walk.answer(8);
  walk.frames(30, false, false);
  EXPECT_LT(walk.doubt.estimate()->sd_m(), 0.3);
  ++walk.step.segment;
  walk.frames(1);
  EXPECT_GT(walk.doubt.estimate()->sd_m(), 2.9);  // of 3.1 s
}

TEST(PoseDoubt, AViewThatFitsNothingSpeaksAgainstTheGuessUntilItFits) {
  Walk walk;
  walk.frames(8);
  walk.answer(8);
  walk.frames(4, false, false, true);
  EXPECT_GT(walk.doubt.estimate()->sd_m(), 0.3);
  walk.frames(1);
  EXPECT_LT(walk.doubt.estimate()->sd_m(), 0.1);
}

TEST(PoseDoubt, InputsThatContradictEachOtherLoseTheDeviceUntilTheNextAnswer) {
  Walk walk;
  walk.frames(8);
  walk.answer(8);
  walk.frames(32, true);
  EXPECT_GT(walk.doubt.estimate()->sd_m(), 0.3);
  walk.answer(40);
  EXPECT_LT(walk.doubt.estimate()->sd_m(), 0.02);
}

}  // namespace
}  // namespace liloc
