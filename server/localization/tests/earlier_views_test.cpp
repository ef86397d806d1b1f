#include "server/localization/earlier_views.hpp"

#include <gmock/gmock.h>

#include "common/registration/target/target.hpp"

namespace liloc {
namespace {

constexpr StampNs kT0 = 1'700'000'000'000'000'000;
const Camera kCamera{160, 120, 120.0, 120.0, 79.5, 59.5, 0.001};

/// A wall at `depth_m`, 2 m wide, and before it somebody 0.4 m wide at `x_m`, if given.
Cloud view_of_wall(double depth_m, std::optional<double> x_m = {}) {
  Cloud cloud;
  for (double y = -0.8; y < 0.8; y += 0.05)
    for (double x = -1; x < 1; x += 0.05) {
      const bool somebody = x_m && std::abs(x - *x_m) < 0.2;
      const double z = somebody ? depth_m / 2 : depth_m;
      cloud.points.push_back((Eigen::Vector3d(x, y, depth_m) * (z / depth_m)).cast<float>());
    }
  return cloud;
}

SpotRequest request_at(double at_s, const Pose& T_odom_sensor = Pose::Identity(), std::uint32_t segment = 1) {
  SpotRequest request;
  request.stamp_ns = kT0 + from_seconds(at_s);
  request.T_odom_sensor = T_odom_sensor;
  request.odom_segment = segment;
  return request;
}

SightView sight_of(const Cloud& cloud) {
  return make_query(cloud, &kCamera, {}).view;
}

std::size_t near_points(const Cloud& cloud, double depth_m) {
  return static_cast<std::size_t>(
      std::ranges::count_if(cloud.points, [&](const auto& p) { return p.z() < 0.75 * depth_m; }));
}

TEST(EarlierViews, WhoHasComeIntoViewMovesAndTheWallDoesNot) {
  EarlierViews views;
  views.add(request_at(0), sight_of(view_of_wall(3)));
  const Cloud now = view_of_wall(3, 0.1);
  const auto moving = views.moving(request_at(0.2), now);
  EXPECT_EQ(moving.size(), near_points(now, 3));
  for (const std::uint32_t i : moving) EXPECT_LT(now.points[i].z(), 2);
  EXPECT_THAT(views.moving(request_at(0.2), view_of_wall(3)), testing::IsEmpty());
}

TEST(EarlierViews, FollowsTheDeviceByItsOdometry) {
  EarlierViews views;
  Pose T_odom_sensor = Pose::Identity();
  views.add(request_at(0, T_odom_sensor), sight_of(view_of_wall(3)));
  T_odom_sensor.translation().z() = 0.5;  // half a metre nearer: the same wall, now at 2.5 m
  EXPECT_THAT(views.moving(request_at(0.2, T_odom_sensor), view_of_wall(2.5)), testing::IsEmpty());
}

TEST(EarlierViews, OtherSegmentsAndOldViewsSayNothing) {
  const Cloud now = view_of_wall(3, 0.1);
  EarlierViews views;
  views.add(request_at(0), sight_of(view_of_wall(3)));
  EXPECT_FALSE(views.moving(request_at(5.9), now).empty());
  EXPECT_TRUE(views.moving(request_at(6.1), now).empty());
  EXPECT_TRUE(views.moving(request_at(0.2, Pose::Identity(), 2), now).empty());
  EXPECT_TRUE(views.moving(request_at(-0.2), now).empty()) << "its clock was set back";
}

TEST(EarlierViews, WhereAllMovesOdometryIsWrong) {
  EarlierViews views;
  views.add(request_at(0), sight_of(view_of_wall(3)));
  EXPECT_TRUE(views.moving(request_at(0.2), view_of_wall(2)).empty());
}

TEST(EarlierViews, FiveAreRemembered) {
  EarlierViews views;
  views.add(request_at(0), sight_of(view_of_wall(3)));
  for (int i = 1; i <= 5; ++i) views.add(request_at(0.2 * i), sight_of(view_of_wall(3, 0.1)));
  EXPECT_TRUE(views.moving(request_at(1.2), view_of_wall(3, 0.1)).empty()) << "he has been here since";
}

}  // namespace
}  // namespace liloc
