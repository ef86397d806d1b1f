#pragma once
// The two sides of a global registration, each with what is computed once and read by every proposer and the judge.
#include <vector>

#include "common/geometry/cloud.hpp"
#include "common/registration/nearest_grid.hpp"
#include "common/registration/score_field.hpp"
#include "common/registration/sight.hpp"

namespace liloc {

/// The room: cloud and views in the map frame. Immutable once made; shared by all threads.
struct Target {
  Cloud cloud;   ///< one point per voxel, normals towards the sensor that saw it
  Cloud coarse;  ///< the same at twice the voxel size
  NearestGrid nearest, nearest_coarse;
  std::vector<SightView> views;       ///< the ceiling's; empty when two bare clouds are aligned
  ScoreField field_coarse, field_fine;  ///< for the gravity search
};

struct TargetOptions {
  double voxel_size_m = 0.05;
  bool with_fields = true;  ///< the gravity search needs them; a refinement does not
};
[[nodiscard]] Target make_target(Cloud cloud_map, std::vector<SightView> views, const TargetOptions& options);

/// The device's cloud in its sensor frame.
struct Query {
  Cloud cloud;   ///< one point per voxel, normals towards the device
  Cloud medium;  ///< at twice the voxel size: refinement far from the answer
  Cloud sparse;  ///< a few hundred points spread evenly in space: search
  SightView view;  ///< rebuilt from the cloud; empty when no camera is known
};

struct QueryOptions {
  double voxel_size_m = 0.05;
  std::size_t sparse_points = 300;
  std::uint64_t seed = 1;
};
/// `camera` null: no view. Drops points that hang in the air.
[[nodiscard]] Query make_query(const Cloud& cloud_sensor, const Camera* camera, const QueryOptions& options);

}  // namespace liloc
