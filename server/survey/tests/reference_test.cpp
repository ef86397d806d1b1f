#include "server/survey/reference.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "server/survey/tests/ceiling.hpp"

namespace liloc::survey {
namespace {

using namespace test;
using testing::HasSubstr;

Cloud room_scan(float unit) {
  Cloud scan = rest_of(scans(1), 3);
  scan.normals.clear();
  for (Eigen::Vector3f& p : scan.points) p *= unit;
  return scan;
}

TEST(Reference, FacesWhoeverLooks) {
  const Reference reference = Reference::create(room_scan(1), kVoxel_m).value();
  for (const Eigen::Vector3f& from : {Eigen::Vector3f(3, 2.5F, 2.5F), Eigen::Vector3f(3, 2.5F, -5)}) {
    const Cloud seen = reference.facing(from);
    ASSERT_EQ(seen.points, reference.cloud_map().points);
    for (std::size_t i = 0; i < seen.size(); ++i)
      ASSERT_GE(seen.normals[i].dot(from - seen.points[i]), 0) << seen.points[i].transpose();
  }
}

TEST(Reference, ItsIndexIsOfItsPoints) {
  const Reference reference = Reference::create(room_scan(1), kVoxel_m).value();
  const Cloud& cloud = reference.cloud_map();
  for (std::size_t i = 0; i < cloud.size(); i += 50) {
    const std::int32_t near = reference.nearest().nearest(cloud.points[i]);
    ASSERT_NE(near, NearestGrid::kNone);
    EXPECT_LT((cloud.points[static_cast<std::size_t>(near)] - cloud.points[i]).norm(), 2 * kVoxel_m);
  }
  EXPECT_TRUE(Eigen::AlignedBox3f(Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(6, 5, 2.7F))
                  .contains(reference.middle_map()));
}

TEST(Reference, AnotherUnitAndTooFewPointsAreNamed) {
  EXPECT_THAT(Reference::create(room_scan(1000), kVoxel_m).error().message, HasSubstr("in metres?"));
  EXPECT_THAT(Reference::create(room_scan(0.001F), kVoxel_m).error().message, HasSubstr("in metres?"));
  EXPECT_THAT(Reference::create({}, kVoxel_m).error().message, HasSubstr("in metres?"));
  Cloud few{{{0, 0, 0}, {3, 0, 0}}, {}};
  EXPECT_THAT(Reference::create(few, kVoxel_m).error().message, HasSubstr("of at least 500"));
}

}  // namespace
}  // namespace liloc::survey
