#pragma once
// The two sides of a global registration, each with what is computed once and read by every proposer and the
// judge.
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "common/geometry/cloud.hpp"
#include "common/registration/field/score_fields.hpp"
#include "common/registration/points/nearest_grid.hpp"
#include "common/registration/points/voxel_mask.hpp"
#include "common/registration/sight/map_points.hpp"
#include "common/registration/sight/sight.hpp"

namespace liloc {

/// The surfaces of a room in the map frame, and indices over them. Immutable; any thread may read it.
class Surfaces {
 public:
  /// `cloud_map`: one point per voxel, normals towards the sensor that saw it. `views`: through which lines of
  /// sight space is known to be empty.
  /// `before`: surfaces of the same room a moment ago, at the same voxel size, or null. From them the same
  /// indices are made sooner, where the room has changed.
  Surfaces(const Cloud& cloud_map, std::vector<SightView> views, double voxel_size_m,
           const Surfaces* before = nullptr);

  const Cloud cloud;
  const Cloud coarse;          ///< at twice the voxel size
  const MapPoints map_points;  ///< its points, for the judge
  const NearestGrid nearest, nearest_coarse;

  /// What a device point is worth at each place, at 0.2 m and at 0.1 m: for searches. The first caller builds
  /// them.
  [[nodiscard]] const ScoreFields& field_coarse() const;
  [[nodiscard]] const ScoreFields& field_fine() const;

 private:
  struct Changes;
  Surfaces(const Cloud& cloud_map, const Cloud& coarse_map, std::vector<SightView> views, double voxel_size_m,
           const Surfaces* before);
  Surfaces(const Cloud& cloud_map, const Cloud& coarse_map, std::vector<SightView> views, double voxel_size_m,
           const Surfaces* before, const Changes& changes);
  void build_fields(const Surfaces* before, const CloudChange* change) const;

  const std::vector<SightView> views_;
  mutable std::once_flag once_;
  mutable std::atomic<bool> has_fields_ = false;
  mutable std::vector<FieldLayers> layers_coarse_, layers_fine_;  ///< by region
  mutable ScoreFields field_coarse_, field_fine_;
};

/// Where the ceiling's word does not count at this moment, because somebody moves there or has just left.
class DynamicRegions {
 public:
  /// `moving_map`: what the ceiling sees move; `gone_map`: of the surfaces, what it finds no more; both
  /// thinned.
  DynamicRegions(std::shared_ptr<const Surfaces> surfaces, const std::vector<SightView>& views,
                 const Cloud& moving_map, const Cloud& gone_map = {});

  const VoxelMask mask;                   ///< where somebody moves: lines of sight past them say nothing
  const std::vector<std::uint8_t> stale;  ///< of each point of Surfaces::coarse: hidden, or not there any more
  const MapPoints map_points;             ///< the same points for the judge

  /// The room's, to which the air around whoever moves is unknown. The first caller makes it.
  [[nodiscard]] const ScoreFields& field_coarse() const;

 private:
  const std::shared_ptr<const Surfaces> surfaces_;
  mutable std::once_flag once_;
  mutable ScoreFields field_coarse_;
};

/// What a spot is registered against: surfaces, which many moments share, and what the ceiling sees right now.
struct Target {
  std::shared_ptr<const Surfaces> surfaces;
  std::vector<SightView> views;                        ///< empty when two bare clouds are aligned
  std::shared_ptr<const DynamicRegions> dynamic = {};  ///< null: nothing moves

  [[nodiscard]] const Surfaces* operator->() const { return surfaces.get(); }
  /// Null: nothing moves.
  [[nodiscard]] const VoxelMask* dynamic_mask() const {
    return dynamic && !dynamic->mask.empty() ? &dynamic->mask : nullptr;
  }
  [[nodiscard]] const ScoreFields& field_coarse() const {
    return dynamic ? dynamic->field_coarse() : surfaces->field_coarse();
  }
};

/// Both from one moment.
[[nodiscard]] Target make_target(const Cloud& cloud_map, std::vector<SightView> views, double voxel_size_m);

/// The device's cloud in its sensor frame.
struct Query {
  Cloud cloud;     ///< one point per voxel, normals towards the device
  Cloud medium;    ///< at twice the voxel size: refinement and judgement
  Cloud sparse;    ///< a few hundred points spread evenly in space: search
  SightView view;  ///< rebuilt from the cloud; empty when no camera is known
};

/// Defaults are by hand where nothing else is said.
struct QueryOptions {
  double voxel_size_m = 0.05;  ///< paper, section 3.1.5
  std::size_t sparse_points = 300;
  std::uint64_t seed = 1;
};
/// `camera` null: no view. `extra_sensor`: surfaces around the frame that the device saw shortly before; they
/// match, but say nothing of what the frame looks through. `moving`: points of `cloud_sensor`, by index, that
/// are seen but no part of the room. Drops points that hang in the air.
[[nodiscard]] Query make_query(const Cloud& cloud_sensor, const Camera* camera, const QueryOptions& options,
                               const Cloud& extra_sensor = {}, const std::vector<std::uint32_t>& moving = {});

}  // namespace liloc
