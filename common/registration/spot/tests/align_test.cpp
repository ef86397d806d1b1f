#include "common/registration/spot/align.hpp"

#include <gtest/gtest.h>

#include <tuple>

#include "common/geometry/depth.hpp"
#include "common/testing/box_room.hpp"

namespace liloc {
namespace {

/// What a camera sees that is turned about at a place: a fragment, in the frame of its first view.
Cloud fragment(const scene::BoxRoom& room, const Eigen::Vector3d& place, double from_rad, double to_rad,
               unsigned seed) {
  Cloud cloud;
  for (double yaw = from_rad; yaw <= to_rad + 1e-9; yaw += 0.5) {
    const Pose T = scene::looking(place, yaw, radians(15));
    append(cloud, transformed(T, *depth_to_cloud(scene::render(room, T, scene::small_camera(), 1, 0.004, seed),
                                                 scene::small_camera())));
  }
  return transformed(scene::looking(place, from_rad, radians(15)).inverse(), cloud);
}

Pose pose_of(const Eigen::Vector3d& place, double from_rad) {
  return scene::looking(place, from_rad, radians(15));
}

struct FragmentPair {
  Cloud source, target;
  Pose T_target_source;
};

FragmentPair fragment_pair(unsigned seed, double turned_rad) {
  const scene::BoxRoom room = scene::furnished_room(seed);
  const Eigen::Vector3d here(3, 2.5, 1.3), there(2.4, 2.2, 1.4);
  const double at = 0.7 * seed;
  return {fragment(room, there, at + turned_rad, at + turned_rad + 1.0, seed + 100),
          fragment(room, here, at, at + 1.0, seed),
          pose_of(here, at).inverse() * pose_of(there, at + turned_rad)};
}

class AlignLaw : public testing::TestWithParam<unsigned> {};

TEST_P(AlignLaw, TrustedIsRightAndConfidenceIsAProbability) {
  for (const double turned_rad : {0.0, 0.8, 1.6, 3.1}) {
    const FragmentPair pair = fragment_pair(GetParam(), turned_rad);
    const auto result = align_clouds(pair.source, pair.target, {});
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_GE(result->confidence, 0);
    EXPECT_LE(result->confidence, 1);
    EXPECT_EQ(result->trusted, result->confidence >= 1 - AlignOptions{}.risk);
    const bool right = distance_m(result->T_target_source, pair.T_target_source) < 0.2 &&
                       degrees(angle_between_rad(result->T_target_source, pair.T_target_source)) < 5;
    EXPECT_TRUE(right || !result->trusted) << "turned by " << turned_rad << ", " << result->confidence;
    if (turned_rad == 0) {
      EXPECT_TRUE(right && result->trusted) << result->confidence;
    }
  }
}

TEST_P(AlignLaw, OtherRoomsAreNotTrusted) {
  const auto result =
      align_clouds(fragment_pair(GetParam(), 0).source, fragment_pair(GetParam() + 1, 2).target, {});
  ASSERT_TRUE(result);
  EXPECT_FALSE(result->trusted) << result->confidence;
}

TEST_P(AlignLaw, ARoomThatLooksTheSameAfterAHalfTurnIsNotTrusted) {
  const scene::BoxRoom bare;
  const Eigen::Vector3d middle(3, 2.5, 1.35);
  const double at = 0.7 * GetParam();
  const auto result = align_clouds(fragment(bare, middle, at, at + 2 * M_PI, GetParam()),
                                   fragment(bare, middle, 0, 2 * M_PI, GetParam() + 50), {});
  ASSERT_TRUE(result);
  EXPECT_LE(result->confidence, 0.8);
  EXPECT_FALSE(result->trusted);
}

INSTANTIATE_TEST_SUITE_P(Seeds, AlignLaw, testing::Range(1U, 7U));

TEST(AlignOptions, TheRiskIsAProbability) {
  const Cloud cloud = fragment_pair(1, 0).source;
  for (const double risk : {0.0, 1.0, -0.1, std::nan("")}) {
    AlignOptions options;
    options.risk = risk;
    EXPECT_FALSE(align_clouds(cloud, cloud, options)) << risk;
  }
}

bool near(const Pose& a, const Pose& b) {
  return distance_m(a, b) < 0.1 && degrees(angle_between_rad(a, b)) < 3;
}

Cloud two_walls_and_a_box(unsigned seed) {
  const scene::BoxRoom room = scene::furnished_room(seed);
  Cloud cloud;
  for (double yaw = 0; yaw < 1.6; yaw += 0.5) {
    const Pose T = scene::looking({3, 2.5, 1.3}, yaw);
    append(cloud, transformed(T, *depth_to_cloud(scene::render(room, T, scene::small_camera(), 1, 0.004, seed),
                                                 scene::small_camera())));
  }
  return transformed(scene::looking({3, 2.5, 1.3}, 0.7).inverse(), cloud);
}

TEST(Align, MapsTheSourceIntoTheTarget) {
  for (unsigned seed : {1U, 2U, 3U}) {
    const Cloud target = two_walls_and_a_box(seed);
    Vector6d a;
    a << 0.2, 0.5, -0.1, 0.6, -0.2, 0.4;
    const Pose T_target_source = increment(a);
    const auto result = align_clouds(transformed(T_target_source.inverse(), target), target, {});
    ASSERT_TRUE(result);
    EXPECT_TRUE(near(result->T_target_source, T_target_source)) << "seed " << seed;
    EXPECT_GT(result->fitness, 0.9);
  }
}

TEST(Align, HostileCloudsAreErrorsOrUntrusted) {
  const Cloud good = two_walls_and_a_box(1);
  Cloud one, planar, nan, same;
  one.points = {{0, 0, 1}};
  for (int i = 0; i < 100; ++i)
    for (int j = 0; j < 100; ++j) planar.points.emplace_back(0.03F * i, 0.03F * j, 2.0F);
  nan.points.assign(1000, Eigen::Vector3f(NAN, NAN, NAN));
  same.points.assign(100000, Eigen::Vector3f(1, 1, 1));
  for (const Cloud& bad : {Cloud{}, one, nan, same}) {
    EXPECT_FALSE(align_clouds(bad, good, {}));
    EXPECT_FALSE(align_clouds(good, bad, {}));
  }
  const auto flat = align_clouds(planar, planar, {});
  EXPECT_TRUE(!flat || !flat->trusted) << "a plane slides on itself";
  AlignOptions options;
  options.voxel_size_m = 0;
  EXPECT_FALSE(align_clouds(good, good, options));
}

TEST(Align, CloudsInMillimetresAreNamedAsSuch) {
  const Cloud good = two_walls_and_a_box(1);
  Cloud millimetres = good;
  for (Eigen::Vector3f& p : millimetres.points) p *= 1000;
  const std::tuple<const Cloud*, const Cloud*, const char*> cases[] = {{&millimetres, &good, "source"},
                                                                       {&good, &millimetres, "target"}};
  for (const auto& [source, target, name] : cases) {
    const auto result = align_clouds(*source, *target, {});
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find(name), std::string::npos) << result.error().message;
    EXPECT_NE(result.error().message.find("millimetres"), std::string::npos) << result.error().message;
  }
}

TEST(Align, CloudsFarFromTheirOriginAreErrorsAndASinglePointThereIsNot) {
  const Cloud good = two_walls_and_a_box(1);
  Cloud far = good, one_far = good;
  for (Eigen::Vector3f& p : far.points) p.x() += 1e6F;
  one_far.points.emplace_back(1e7F, 1e7F, 1e7F);
  const auto result = align_clouds(far, good, {});
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("source"), std::string::npos) << result.error().message;
  EXPECT_TRUE(align_clouds(one_far, good, {}));
}

}  // namespace
}  // namespace liloc
