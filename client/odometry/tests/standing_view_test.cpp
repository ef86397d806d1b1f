#include "client/odometry/standing_view.hpp"

#include <gtest/gtest.h>

#include "client/odometry/tests/walked_by.hpp"

namespace liloc {
namespace {

using namespace test;

Pose standpoint() {
  return scene::looking({3, 2.5, 1.2}, 0.6, 0.2);
}

/// Learned from frames that stand, with the reference set.
StandingView looking_at(const scene::BoxRoom& room) {
  StandingView standing(scene::small_camera());
  for (int i = 0; i < 10; ++i) standing.next(view(room, standpoint(), i));
  standing.refer(standpoint());
  return standing;
}

class StandingLaw : public testing::TestWithParam<unsigned> {};

TEST_P(StandingLaw, StandsWhileNothingMoves) {
  const auto room = scene::furnished_room(GetParam());
  StandingView standing = looking_at(room);
  for (int i = 10; i < 40; ++i) {
    const StandingCheck check = standing.compare(view(room, standpoint(), i));
    EXPECT_FALSE(check.moved) << i;
    EXPECT_GT(check.share, 0.95);
  }
}

TEST_P(StandingLaw, TellsASmallMotionOfAnyKind) {
  const auto room = scene::furnished_room(GetParam());
  StandingView standing = looking_at(room);
  for (int axis = 0; axis < 6; ++axis) {
    Vector6d motion = Vector6d::Zero();
    motion[axis] = axis < 3 ? radians(0.8) : 0.03;
    const StandingCheck check = standing.compare(view(room, standpoint() * increment(motion), 10 + axis));
    EXPECT_FALSE(check.stands) << axis << ": " << check.agree_least << " agree, known to " << check.sd_m;
  }
}

TEST_P(StandingLaw, MeasuresWhatItTells) {
  const auto room = scene::furnished_room(GetParam());
  StandingView standing = looking_at(room);
  for (int axis = 0; axis < 6; ++axis) {
    Vector6d motion = Vector6d::Zero();
    motion[axis] = axis < 3 ? radians(0.1) : 0.003;
    const StandingCheck check = standing.compare(view(room, standpoint() * increment(motion), 20 + axis));
    if (check.sd_m > 0.005) continue;  // this room shows too little
    const Vector6d off = check.motion - motion;
    EXPECT_LT(off.head<3>().norm(), radians(0.15)) << axis;
    EXPECT_LT(off.tail<3>().norm(), 0.006) << axis;
  }
}
INSTANTIATE_TEST_SUITE_P(Rooms, StandingLaw, testing::Range(1U, 9U));

TEST(StandingView, ABareWallProvesNothing) {
  const Pose T = scene::looking({0, 1, 1.2}, 1.5707963, 0.4);
  StandingView standing(scene::small_camera());
  for (int i = 0; i < 10; ++i) standing.next(view(scene::corridor(), T, i));
  standing.refer(T);
  for (int i = 10; i < 20; ++i) {
    Pose T_along = T;
    T_along.translation().x() += 0.02 * (i - 10);
    const StandingCheck check = standing.compare(view(scene::corridor(), T_along, i));
    EXPECT_GT(check.share, 0.9);
    EXPECT_FALSE(check.stands) << i;
  }
}

}  // namespace
}  // namespace liloc
