#include "proto-tests/sim/shapes/mesh.hpp"

#include <cmath>
#include <numbers>

namespace liloc::sim {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

void add_triangle(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, Material material) {
  mesh.triangles.push_back({a, b, c});
  mesh.materials.push_back(material);
}

std::uint32_t add_vertex(Mesh& mesh, const Eigen::Vector3d& p) {
  mesh.vertices.emplace_back(p.cast<float>());
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

}  // namespace

void add_quad(Mesh& mesh, const Eigen::Vector3d& corner, const Eigen::Vector3d& edge_a,
              const Eigen::Vector3d& edge_b, Material material) {
  const std::uint32_t a = add_vertex(mesh, corner), b = add_vertex(mesh, corner + edge_a),
                      c = add_vertex(mesh, corner + edge_a + edge_b), d = add_vertex(mesh, corner + edge_b);
  add_triangle(mesh, a, b, c, material);
  add_triangle(mesh, a, c, d, material);
}

void add_box(Mesh& mesh, const Pose& T_mesh_box, const Eigen::Vector3d& size, Material material) {
  const Eigen::Vector3d low = T_mesh_box * (-0.5 * size), high = T_mesh_box * (0.5 * size);
  const Eigen::Matrix3d edges = T_mesh_box.linear() * size.asDiagonal();
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d a = edges.col((axis + 1) % 3), b = edges.col((axis + 2) % 3);
    add_quad(mesh, low, a, b, material);
    add_quad(mesh, high, -a, -b, material);
  }
}

void add_box(Mesh& mesh, const Eigen::Vector3d& centre, const Eigen::Vector3d& size, Material material) {
  add_box(mesh, upright(centre, 0), size, material);
}

void add_cylinder(Mesh& mesh, const Eigen::Vector3d& foot, double radius_m, double top_radius_m,
                  double height_m, int sides, Material material) {
  const Eigen::Vector3d rise(0, 0, height_m);
  const std::uint32_t bottom = add_vertex(mesh, foot), top = add_vertex(mesh, foot + rise);
  const std::uint32_t first = top + 1;
  for (int i = 0; i < sides; ++i) {
    const Eigen::Vector3d out(std::cos(kTurn * i / sides), std::sin(kTurn * i / sides), 0);
    add_vertex(mesh, foot + radius_m * out);
    add_vertex(mesh, foot + top_radius_m * out + rise);
  }
  for (int i = 0; i < sides; ++i) {
    const std::uint32_t a = first + 2 * static_cast<std::uint32_t>(i),
                        b = first + 2 * static_cast<std::uint32_t>((i + 1) % sides);
    add_triangle(mesh, a, b, b + 1, material);
    add_triangle(mesh, a, b + 1, a + 1, material);
    add_triangle(mesh, bottom, b, a, material);
    add_triangle(mesh, top, a + 1, b + 1, material);
  }
}

void add_ellipsoid(Mesh& mesh, const Eigen::Vector3d& centre, const Eigen::Vector3d& radii_m, int rings,
                   Material material) {
  const int sides = 2 * rings;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (int ring = 0; ring <= rings; ++ring) {
    const double polar = std::numbers::pi * ring / rings;
    for (int i = 0; i < sides; ++i) {
      const double turn = kTurn * i / sides;
      const Eigen::Vector3d unit(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                                 std::cos(polar));
      add_vertex(mesh, centre + radii_m.cwiseProduct(unit));
    }
  }
  for (int ring = 0; ring < rings; ++ring)
    for (int i = 0; i < sides; ++i) {
      const auto row = first + static_cast<std::uint32_t>(ring * sides),
                 next = row + static_cast<std::uint32_t>(sides);
      const auto a = static_cast<std::uint32_t>(i), b = static_cast<std::uint32_t>((i + 1) % sides);
      if (ring > 0) add_triangle(mesh, row + a, row + b, next + b, material);
      if (ring + 1 < rings) add_triangle(mesh, row + a, next + b, next + a, material);
    }
}

void add_mesh(Mesh& to, const Mesh& mesh, const Pose& T_to_mesh) {
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  const Eigen::Isometry3f T = T_to_mesh.cast<float>();
  for (const auto& v : mesh.vertices) to.vertices.emplace_back(T * v);
  for (const auto& t : mesh.triangles) to.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  to.materials.insert(to.materials.end(), mesh.materials.begin(), mesh.materials.end());
}

Pose upright(const Eigen::Vector3d& at, double yaw_rad) {
  Pose T = Pose::Identity();
  T.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = at;
  return T;
}

}  // namespace liloc::sim
