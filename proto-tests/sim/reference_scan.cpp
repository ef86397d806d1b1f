#include "proto-tests/sim/reference_scan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/geometry/voxel.hpp"
#include "proto-tests/sim/shapes/ray_caster.hpp"

namespace liloc::sim {
namespace {

using Eigen::Vector3d;
constexpr int kSide = 200;                                  // pixels of a cube's face
constexpr double kStationSpacing_m = 3.0, kVoxel_m = 0.04;  // by hand: no corner stays unseen

/// One of six views of 90 degrees that together see everything around `at`.
Pose cube_face(const Vector3d& at, int side) {
  const double quarter = 0.5 * std::numbers::pi;
  Pose T = Pose::Identity();
  T.translation() = at;
  if (side < 4) {
    T.rotate(Eigen::AngleAxisd(side * quarter, Vector3d::UnitZ()));
    T.rotate(Eigen::AngleAxisd(quarter, Vector3d::UnitX()));
  } else if (side == 5) {
    T.rotate(Eigen::AngleAxisd(2 * quarter, Vector3d::UnitX()));
  }
  return T;
}

void append_view(Cloud& scan_map, const View& view, const Camera& face, const Pose& T_map_face) {
  const Eigen::Isometry3f T = T_map_face.cast<float>();
  for (int v = 0; v < kSide; ++v)
    for (int u = 0; u < kSide; ++u) {
      const auto pixel = static_cast<std::size_t>(v * kSide + u);
      const float z = view.depth_m[pixel];
      if (z < 0.3F || view.material[pixel] == Material::glass) continue;
      const Eigen::Vector3d ray((u - face.cx) / face.fx, (v - face.cy) / face.fy, 1);
      scan_map.points.emplace_back(T * (z * ray.cast<float>()));
    }
}

std::vector<Vector3d> stations(const Vector3d& size) {
  const int columns = std::max(1, static_cast<int>(std::lround(size.x() / kStationSpacing_m)));
  const int rows = std::max(1, static_cast<int>(std::lround(size.y() / kStationSpacing_m)));
  std::vector<Vector3d> places;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      for (const double z : {1.4, size.z() - 0.4})
        places.emplace_back((column + 0.5) * size.x() / columns, (row + 0.5) * size.y() / rows, z);
  return places;
}

}  // namespace

Result<Cloud> scan_reference(const Layout& layout, int threads) {
  const double middle = 0.5 * (kSide - 1);
  const Camera face{kSide, kSide, 0.5 * kSide, 0.5 * kSide, middle, middle, 0.001};
  auto caster = RayCaster::create(threads);
  if (!caster) return tl::unexpected(caster.error());
  Mesh mesh = layout.room;
  for (const Item& item : layout.items) add_mesh(mesh, item.furniture.mesh, item.T_map_reference());
  if (const auto number = caster->add(mesh); !number) return tl::unexpected(number.error());
  caster->commit();
  Cloud scan_map;
  for (const Vector3d& at : stations(layout.size_m)) {
    Cloud seen_map;
    for (int side = 0; side < 6; ++side) {
      const Pose T_map_face = cube_face(at, side);
      append_view(seen_map, caster->look(face, T_map_face, 100), face, T_map_face);
    }
    append(scan_map,
           voxel_downsample(seen_map, kVoxel_m));  // thinned at once, so that a hall stays small in memory
  }
  return voxel_downsample(scan_map, kVoxel_m);
}

}  // namespace liloc::sim
