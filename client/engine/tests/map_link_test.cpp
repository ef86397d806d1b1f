#include "client/engine/map_link.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

SpotReply verified(StampNs stamp, double x, std::uint32_t segment = 0) {
  SpotReply reply;
  reply.stamp_ns = stamp;
  reply.status = SpotStatus::verified;
  reply.reason = Reason::confirmed;
  reply.odom_segment = segment;
  reply.T_map_odom = Pose(Eigen::Translation3d(x, 0, 0));
  return reply;
}

TEST(MapLink, OnlyVerifiedAnswersOfTheSegmentMoveIt) {
  MapLink link(from_ms(2400));
  SpotReply provisional = verified(1, 5);
  provisional.status = SpotStatus::provisional;
  EXPECT_FALSE(link.add(provisional, 0));
  EXPECT_FALSE(link.T_map_odom());
  EXPECT_FALSE(link.add(verified(2, 5, 1), 0));
  EXPECT_TRUE(link.add(verified(3, 5), 0));
  EXPECT_DOUBLE_EQ(link.T_map_odom()->translation().x(), 5);
}

TEST(MapLink, AnOvertakenAnswerDoesNotMoveItBack) {
  MapLink link(from_ms(2400));
  EXPECT_TRUE(link.add(verified(from_ms(1600), 2), 0));
  EXPECT_FALSE(link.add(verified(from_ms(800), 1), 0));
  EXPECT_DOUBLE_EQ(link.T_map_odom()->translation().x(), 2);
}

TEST(MapLink, CoastsWhenTheServerIsSilentOrTheSegmentBroke) {
  MapLink link(from_ms(2400));
  EXPECT_EQ(link.tracking(from_ms(100), 0), Tracking::searching);
  ASSERT_TRUE(link.add(verified(from_ms(1000), 1), 0));
  EXPECT_EQ(link.tracking(from_ms(3400), 0), Tracking::tracking);
  EXPECT_EQ(link.tracking(from_ms(3401), 0), Tracking::coasting);
  SpotReply provisional = verified(from_ms(3000), 1);
  provisional.status = SpotStatus::provisional;
  EXPECT_FALSE(link.add(provisional, 0));  // it talks again
  EXPECT_EQ(link.tracking(from_ms(3401), 0), Tracking::tracking);
  EXPECT_EQ(link.tracking(from_ms(3401), 1), Tracking::coasting);
  EXPECT_TRUE(link.T_map_odom());  // bridged
  EXPECT_TRUE(link.add(verified(from_ms(3500), 1, 1), 1));
  EXPECT_EQ(link.tracking(from_ms(3600), 1), Tracking::tracking);
}

}  // namespace
}  // namespace liloc
