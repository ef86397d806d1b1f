#pragma once
// A seeded box room watched by three ceiling sensors, and a device in it.
#include "common/geometry/depth.hpp"
#include "common/geometry/voxel.hpp"
#include "common/registration/points/normals.hpp"
#include "common/registration/spot/spot.hpp"
#include "common/testing/box_room.hpp"

namespace liloc {

struct WatchedRoom {
  scene::BoxRoom room;
  Target target;
  Pose T_map_device;
  Query query;
  Eigen::Vector3d up_device;

  [[nodiscard]] SpotProblem problem() const { return {target, query, up_device}; }
};

inline std::vector<Pose> ceiling_poses() {
  return {scene::looking({0.2, 0.2, 2.6}, radians(45), radians(35)),
          scene::looking({5.8, 0.3, 2.6}, radians(130), radians(35)),
          scene::looking({3.0, 4.8, 2.6}, radians(-90), radians(35))};
}

/// `T_map_room`: how the map's frame lies to the room, whose z is up.
inline Target watch(const scene::BoxRoom& room, unsigned seed, double noise_m = 0.005,
                    const Pose& T_map_room = Pose::Identity()) {
  const Camera camera = scene::small_camera();
  Cloud stitched;
  std::vector<SightView> views;
  for (const Pose& T_room_sensor : ceiling_poses()) {
    const Pose T_map_sensor = T_map_room * T_room_sensor;
    const DepthImage image =
        scene::render(room, T_room_sensor, camera, seed * 10 + views.size(), noise_m, seed);
    const Cloud thin =
        with_normals(voxel_downsample(*depth_to_cloud(image, camera), 0.05), Eigen::Vector3f::Zero());
    append(stitched, transformed(T_map_sensor, thin));
    views.push_back(SightView::from_depth(image, camera, T_map_sensor.inverse(), 2, 8.5));
  }
  return make_target(voxel_downsample(stitched, 0.05), std::move(views), 0.05);
}

inline Query look(const scene::BoxRoom& room, const Pose& T_map_device, unsigned seed, double noise_m = 0.005) {
  const Camera camera = scene::small_camera();
  const DepthImage image = scene::render(room, T_map_device, camera, seed * 10 + 7, noise_m, seed);
  return make_query(*depth_to_cloud(image, camera), &camera, {});
}

inline WatchedRoom watched_room(unsigned seed) {
  WatchedRoom w;
  w.room = scene::furnished_room(seed);
  w.target = watch(w.room, seed);
  w.T_map_device = scene::looking({2.4 + 0.07 * seed, 2.1, 1.2}, 0.9 * seed, radians(12));
  w.query = look(w.room, w.T_map_device, seed);
  w.up_device = w.T_map_device.linear().transpose() * Eigen::Vector3d::UnitZ();
  return w;
}

}  // namespace liloc
