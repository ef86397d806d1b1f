#pragma once
// Depth by ray casting: rigid bodies, each with its own tree built once; moving one rebuilds only the tree of
// bodies.
#include <memory>
#include <vector>

#include "common/geometry/camera.hpp"
#include "proto-tests/sim/shapes/mesh.hpp"

namespace liloc::sim {

/// What each pixel's ray met first, row by row.
struct View {
  std::vector<float> depth_m;        ///< along the optical axis; 0: nothing within range
  std::vector<float> cos_incidence;  ///< between ray and surface normal, 0..1
  std::vector<Material> material;
};

/// Not thread-safe itself; `look` uses `threads` threads while it runs.
class RayCaster {
 public:
  /// Errors: Embree cannot start here.
  [[nodiscard]] static Result<RayCaster> create(int threads);
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;
  ~RayCaster();

  /// Adds a body at the origin; returns its number. Errors: out of memory.
  [[nodiscard]] Result<std::size_t> add(const Mesh& mesh);
  void move(std::size_t body, const Pose& T_map_body);
  /// Makes moves visible to `look`.
  void commit();
  [[nodiscard]] View look(const Camera& camera, const Pose& T_map_camera, double range_m) const;

 private:
  struct Impl;
  explicit RayCaster(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace liloc::sim
