#include "common/registration/target/surface_bits.hpp"

#include <gtest/gtest.h>

#include "common/geometry/depth.hpp"
#include "common/geometry/voxel.hpp"
#include "common/registration/points/normals.hpp"
#include "common/testing/box_room.hpp"

namespace liloc {
namespace {

/// A furnished room that one ceiling sensor and a device see.
class SurfaceBitsLaw : public testing::TestWithParam<unsigned> {
 protected:
  SurfaceBitsLaw() {
    const scene::BoxRoom room = scene::furnished_room(GetParam());
    const Camera camera = scene::small_camera();
    Cloud map;
    std::vector<SightView> views;
    for (const Pose& T_map_sensor : {scene::looking({0.2, 0.2, 2.6}, radians(45), radians(35)),
                                     scene::looking({5.8, 0.3, 2.6}, radians(130), radians(35))}) {
      const DepthImage image = scene::render(room, T_map_sensor, camera, 0, 0.003, GetParam());
      views.push_back(SightView::from_depth(image, camera, T_map_sensor.inverse(), 2, 10));
      const Cloud cloud =
          with_normals(voxel_downsample(*depth_to_cloud(image, camera), 0.05), Eigen::Vector3f::Zero());
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        map.points.push_back(T_map_sensor.cast<float>() * cloud.points[i]);
        map.normals.push_back(T_map_sensor.linear().cast<float>() * cloud.normals[i]);
      }
    }
    target = make_target(map, views, 0.05);
    T_map_device = scene::looking({2.5, 2.2, 1.2}, 0.7 * GetParam(), radians(12));
    const DepthImage image = scene::render(room, T_map_device, camera, 0, 0.003, GetParam() + 50);
    query = make_query(voxel_downsample(*depth_to_cloud(image, camera), 0.05), &camera, {});
  }
  Target target;
  Query query;
  Pose T_map_device;
};

TEST_P(SurfaceBitsLaw, TheRightPlaceRecognizesMoreThanOneBesideIt) {
  SurfaceBits right, beside;
  right.add(target, query.medium, T_map_device);
  beside.add(target, query.medium, T_map_device * scene::looking({0.9, 0.4, 0.0}, 0.4));
  EXPECT_GT(right.sum(), 0);
  EXPECT_GT(right.sum(), 1.5 * beside.sum());
  EXPECT_LE(right.sum(), static_cast<double>(right.cells()));
}

TEST_P(SurfaceBitsLaw, ASecondLookAtTheSameAddsNothing) {
  SurfaceBits bits;
  bits.add(target, query.medium, T_map_device);
  const double once = bits.sum();
  bits.add(target, query.medium, T_map_device);
  EXPECT_DOUBLE_EQ(bits.sum(), once);
}

INSTANTIATE_TEST_SUITE_P(Seeds, SurfaceBitsLaw, testing::Range(1U, 6U));

}  // namespace
}  // namespace liloc
