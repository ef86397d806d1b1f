#pragma once
// The two sides of a global registration, each with what is computed once and read by every proposer and the judge.
#include <memory>
#include <mutex>
#include <vector>

#include "common/geometry/cloud.hpp"
#include "common/registration/nearest_grid.hpp"
#include "common/registration/score_field.hpp"
#include "common/registration/sight.hpp"

namespace liloc {

/// The room: cloud and views in the map frame. Immutable once made; any thread may read it.
class Target {
 public:
  Cloud cloud;   ///< one point per voxel, normals towards the sensor that saw it
  Cloud coarse;  ///< the same at twice the voxel size
  NearestGrid nearest, nearest_coarse;
  std::vector<SightView> views;  ///< the ceiling's; empty when two bare clouds are aligned

  /// What a device point is worth at each place, at 0.2 m and at 0.1 m: for searches. The first caller builds them.
  [[nodiscard]] const ScoreField& field_coarse() const { return fields().coarse; }
  [[nodiscard]] const ScoreField& field_fine() const { return fields().fine; }

 private:
  struct Fields {
    std::once_flag once;
    ScoreField coarse, fine;
  };
  [[nodiscard]] const Fields& fields() const;
  std::unique_ptr<Fields> fields_ = std::make_unique<Fields>();
};

[[nodiscard]] Target make_target(Cloud cloud_map, std::vector<SightView> views, double voxel_size_m);

/// The device's cloud in its sensor frame.
struct Query {
  Cloud cloud;   ///< one point per voxel, normals towards the device
  Cloud medium;  ///< at twice the voxel size: refinement and judgement
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
