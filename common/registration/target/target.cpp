#include "common/registration/target/target.hpp"

#include <algorithm>
#include <random>

#include "common/geometry/voxel.hpp"
#include "common/registration/points/normals.hpp"

namespace liloc {
namespace {

// Sums of the coarse field must fit a byte by eights; at 0.1 m a conflict is meant.
// Free space at -10 and -40 by hand; from -30 to -50 made no difference (field/DECISIONS.md).
constexpr FieldOptions kCoarseField{0.2, 0.13, -10, 40};  // padded for devices that see 8 m far
constexpr FieldOptions kFineField{0.1, 0.08, -40, 0};

// 0.2 and 0.4 lost, DECISIONS.md.
constexpr double kBeside_m = 0.3;  // of what is seen of somebody from above: the rest, and a step in 0.1 s
// Within which they hide a surface from the device, or are one themselves; by hand.
constexpr double kAround_m = 0.45;
constexpr float kGone_m = 0.05F;              // a voxel; by hand
constexpr double kOfGone_m = 0.15;            // a coarse voxel and a half, from what is gone; by hand
constexpr double kRadius = 2.5, kWidest = 8;  // of neighbourhoods, in voxels; by hand; DECISIONS.md

/// Whether a ceiling sensor looks through the place by now and none sees anything there.
bool gone(const std::vector<SightView>& views, const Eigen::Vector3f& p_map) {
  bool through = false;
  for (const SightView& view : views) {
    const Sight word = view.look(p_map, kGone_m);
    if (word == Sight::agrees) return false;
    through = through || word == Sight::conflict;
  }
  return through;
}

/// Surfaces near who moves, and those that are gone.
std::vector<std::uint8_t> stale_points(const Cloud& cloud_map, const std::vector<SightView>& views,
                                       const VoxelMask& near_moving, const VoxelMask& of_gone) {
  std::vector<std::uint8_t> stale(cloud_map.size(), 0);
  for (std::size_t i = 0; i < cloud_map.size(); ++i) {
    const Eigen::Vector3f& p_map = cloud_map.points[i];
    stale[i] = near_moving.at(p_map) || of_gone.at(p_map) || gone(views, p_map) ? 1 : 0;
  }
  return stale;
}

MapPoints map_points_of(const Cloud& cloud_map, const std::vector<std::uint8_t>& stale) {
  std::vector<Eigen::Vector3f> sound, doubtful;
  for (std::size_t i = 0; i < cloud_map.size(); ++i)
    (stale[i] != 0 ? doubtful : sound).push_back(cloud_map.points[i]);
  return MapPoints(sound, doubtful);
}

NearestGrid nearest_of(const Cloud& cloud, double cell_m, double reach_m, const NearestGrid* before,
                       const CloudChange& change) {
  return before == nullptr ? NearestGrid(cloud.points, cell_m, reach_m)
                           : NearestGrid(cloud.points, cell_m, reach_m, *before, change);
}

/// About `count` points spread evenly in space: the coarsest voxel grid that still has so many, then a random
/// cut.
Cloud spread_points(const Cloud& cloud, std::size_t count, double voxel_size_m, std::uint64_t seed) {
  Cloud thin = cloud;
  for (double size = 8 * voxel_size_m; size > voxel_size_m; size *= 0.75) {
    thin = voxel_downsample(cloud, size);
    if (thin.size() >= count) break;
  }
  std::mt19937_64 rng(seed);
  while (thin.size() > count) {
    const std::size_t i = rng() % thin.size();
    thin.points[i] = thin.points.back();
    thin.points.pop_back();
    if (thin.normals.empty()) continue;
    thin.normals[i] = thin.normals.back();
    thin.normals.pop_back();
  }
  return thin;
}

/// The points alone.
Cloud without(const Cloud& cloud, const std::vector<std::uint32_t>& left_out) {
  std::vector<bool> kept(cloud.size(), true);
  for (const std::uint32_t i : left_out)
    if (i < kept.size()) kept[i] = false;
  Cloud rest;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (kept[i]) rest.points.push_back(cloud.points[i]);
  return rest;
}

}  // namespace

struct Surfaces::Changes {
  CloudChange cloud, coarse;
};

Surfaces::Surfaces(const Cloud& cloud_map, std::vector<SightView> views, double voxel_size_m,
                   const Surfaces* before)
    : Surfaces(cloud_map, voxel_downsample(cloud_map, 2 * voxel_size_m), std::move(views), voxel_size_m,
               before) {}

Surfaces::Surfaces(const Cloud& cloud_map, const Cloud& coarse_map, std::vector<SightView> views,
                   double voxel_size_m, const Surfaces* before)
    : Surfaces(cloud_map, coarse_map, std::move(views), voxel_size_m, before,
               before == nullptr ? Changes{}
                                 : Changes{change_between(before->cloud, cloud_map),
                                           change_between(before->coarse, coarse_map)}) {}

Surfaces::Surfaces(const Cloud& cloud_map, const Cloud& coarse_map, std::vector<SightView> views,
                   double voxel_size_m, const Surfaces* before, const Changes& changes)
    : cloud(cloud_map),
      coarse(coarse_map),
      map_points(coarse.points),
      nearest(nearest_of(cloud, voxel_size_m, 1.3 * voxel_size_m,
                         before == nullptr ? nullptr : &before->nearest, changes.cloud)),
      nearest_coarse(nearest_of(coarse, 3 * voxel_size_m, 0.32,
                                before == nullptr ? nullptr : &before->nearest_coarse, changes.coarse)),
      views_(std::move(views)) {
  if (before != nullptr && before->has_fields_) build_fields(before, &changes.coarse);
}

void Surfaces::build_fields(const Surfaces* before, const CloudChange* change) const {
  std::call_once(once_, [&] {
    const std::vector<Region> regions = regions_of(coarse.points, kFarApart_m);
    const auto layers = [&](const FieldOptions& options, const std::vector<FieldLayers> Surfaces::*member) {
      std::vector<FieldLayers> all;
      for (std::size_t k = 0; k < regions.size(); ++k)
        if (before == nullptr || (before->*member).size() != regions.size())
          all.emplace_back(coarse, views_, options, regions[k]);
        else
          all.emplace_back(coarse, views_, options,
                           FieldLayers::Earlier{(before->*member)[k], before->views_, *change}, regions[k]);
      return all;
    };
    layers_coarse_ = layers(kCoarseField, &Surfaces::layers_coarse_);
    layers_fine_ = layers(kFineField, &Surfaces::layers_fine_);
    field_coarse_ = ScoreFields(layers_coarse_, kCoarseField);
    field_fine_ = ScoreFields(layers_fine_, kFineField);
    has_fields_ = true;
  });
}

const ScoreFields& Surfaces::field_coarse() const {
  build_fields(nullptr, nullptr);
  return field_coarse_;
}

const ScoreFields& Surfaces::field_fine() const {
  build_fields(nullptr, nullptr);
  return field_fine_;
}

DynamicRegions::DynamicRegions(std::shared_ptr<const Surfaces> surfaces, const std::vector<SightView>& views,
                               const Cloud& moving_map, const Cloud& gone_map)
    : mask(moving_map.points, kBeside_m),
      stale(stale_points(surfaces->coarse, views, VoxelMask(moving_map.points, kAround_m),
                         VoxelMask(gone_map.points, kOfGone_m))),
      map_points(map_points_of(surfaces->coarse, stale)),
      surfaces_(std::move(surfaces)) {}

const ScoreFields& DynamicRegions::field_coarse() const {
  if (mask.empty()) return surfaces_->field_coarse();
  std::call_once(once_, [this] {
    field_coarse_ = surfaces_->field_coarse();
    field_coarse_.forget_free_space(mask);
  });
  return field_coarse_;
}

Target make_target(const Cloud& cloud_map, std::vector<SightView> views, double voxel_size_m) {
  auto surfaces = std::make_shared<const Surfaces>(cloud_map, views, voxel_size_m);
  return {std::move(surfaces), std::move(views)};
}

Query make_query(const Cloud& cloud_sensor, const Camera* camera, const QueryOptions& options,
                 const Cloud& extra_sensor, const std::vector<std::uint32_t>& moving) {
  Query query;
  Cloud seen = voxel_downsample(cloud_sensor, options.voxel_size_m);
  if (camera != nullptr) query.view = SightView::from_cloud(seen, *camera, options.voxel_size_m, 80);
  if (!moving.empty()) seen = voxel_downsample(without(cloud_sensor, moving), options.voxel_size_m);
  seen.points.insert(seen.points.end(), extra_sensor.points.begin(), extra_sensor.points.end());
  // A cloud that was thinned to few bytes is sparser than its voxels, and nearly all of it would hang in the
  // air.
  query.cloud = with_normals(seen, Eigen::Vector3f::Zero(),
                             {kRadius * options.voxel_size_m, 5, kWidest * options.voxel_size_m});
  query.medium = voxel_downsample(query.cloud, 2 * options.voxel_size_m);
  query.sparse = spread_points(query.cloud, options.sparse_points, options.voxel_size_m, options.seed);
  return query;
}

}  // namespace liloc
