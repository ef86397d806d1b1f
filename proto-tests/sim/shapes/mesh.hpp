#pragma once
// Triangle meshes from a few solids; everything in a simulated site is made of these.
#include <array>
#include <cstdint>
#include <vector>

#include "common/geometry/pose.hpp"

namespace liloc::sim {

enum class Material : std::uint8_t {
  matte,
  dark,    ///< weak return: more noise, more dropouts
  glass,   ///< mostly no return
  carpet,  ///< a dark floor: lost to some sensors, as good as matte to the default one
};

struct Mesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Material> materials;  ///< one per triangle
};

/// A parallelogram with one corner at `corner` and the others one `edge` away.
void add_quad(Mesh& mesh, const Eigen::Vector3d& corner, const Eigen::Vector3d& edge_a,
              const Eigen::Vector3d& edge_b, Material material = Material::matte);
/// A box of `size` centred at `T_mesh_box`.
void add_box(Mesh& mesh, const Pose& T_mesh_box, const Eigen::Vector3d& size,
             Material material = Material::matte);
/// The same, upright, by its centre.
void add_box(Mesh& mesh, const Eigen::Vector3d& centre, const Eigen::Vector3d& size,
             Material material = Material::matte);
/// An upright cylinder or cone stump standing on `foot`.
void add_cylinder(Mesh& mesh, const Eigen::Vector3d& foot, double radius_m, double top_radius_m,
                  double height_m, int sides, Material material = Material::matte);
/// A ball stretched to the three radii.
void add_ellipsoid(Mesh& mesh, const Eigen::Vector3d& centre, const Eigen::Vector3d& radii_m, int rings,
                   Material material = Material::matte);

/// Adds a whole mesh, moved.
void add_mesh(Mesh& to, const Mesh& mesh, const Pose& T_to_mesh);

/// A pose that turns about z and stands at `at`.
[[nodiscard]] Pose upright(const Eigen::Vector3d& at, double yaw_rad);

}  // namespace liloc::sim
