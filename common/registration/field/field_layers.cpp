#include "common/registration/field/field_layers.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "common/registration/points/voxel_mask.hpp"

namespace liloc {
namespace {

constexpr double kMostCells = 8e6;  // of a plane; by hand: memory
constexpr double kSnap_m = 0.2;     // so that a point at the rim that moves a little moves no cell
constexpr float kSameWay = 0.5F;    // cosine up to which a surface enters the plane of a direction; by hand
constexpr double kReach = 2.2;      // standard deviations; by hand

/// The direction that a plane stands for.
Eigen::Vector3f direction_of(int plane) {
  if (plane == FieldLayers::kUp) return Eigen::Vector3f::UnitZ();
  if (plane == FieldLayers::kDown) return -Eigen::Vector3f::UnitZ();
  const auto azimuth = static_cast<float>(2 * M_PI * plane / FieldLayers::kAzimuths);
  return {std::cos(azimuth), std::sin(azimuth), 0.0F};
}

/// Whether a surface with this normal enters the plane; null: faces everywhere.
bool enters(int plane, const Eigen::Vector3f* normal) {
  static const auto kDirectionOf = [] {
    std::array<Eigen::Vector3f, FieldLayers::kDirections> all;
    for (int p = 0; p < FieldLayers::kDirections; ++p) all[static_cast<std::size_t>(p)] = direction_of(p);
    return all;
  }();
  return normal == nullptr || plane == FieldLayers::kAny ||
         normal->dot(kDirectionOf[static_cast<std::size_t>(plane)]) > kSameWay;
}

}  // namespace

/// The cells about a surface and how near they are. Kept from point to point for its memory.
struct FieldLayers::Stamp {
  explicit Stamp(double sd_m) : reach_m(static_cast<float>(kReach * sd_m)) {
    for (int value = 1; value <= kNear; ++value)
      limits[static_cast<std::size_t>(value)] =
          static_cast<float>(-2 * sd_m * sd_m * std::log((value - 0.5) / kNear));
    int value = kNear;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      value = nearness(reach_m * reach_m / kBins * static_cast<float>(bin), value);
      first_guess[bin] = value;
    }
  }
  /// kNear times the Gaussian of a squared distance, rounded; `guess` may be too high.
  [[nodiscard]] int nearness(float squared, int guess) const {
    while (guess > 0 && squared > limits[static_cast<std::size_t>(guess)]) --guess;
    return guess;
  }
  void take(const FieldLayers& layers, const Eigen::Vector3f& p_map) {
    const Eigen::Array3f q_m = (p_map - layers.origin_).array();
    const auto cell = static_cast<float>(layers.cell_);
    const float squared_reach = reach_m * reach_m, bin = kBins / squared_reach;
    const Eigen::Array3i lo = ((q_m - reach_m) * layers.inverse_).floor().cast<int>().max(0);
    const Eigen::Array3i hi = ((q_m + reach_m) * layers.inverse_).cast<int>().min(layers.size_.array() - 1);
    const Eigen::Array3i box = (hi - lo + 1).max(0);
    if (cells.size() < static_cast<std::size_t>(box.prod())) {
      cells.resize(static_cast<std::size_t>(box.prod()));
      values.resize(cells.size());
    }
    count = 0;
    for (int z = lo.z(); z <= hi.z(); ++z) {
      const float dz = (static_cast<float>(z) + 0.5F) * cell - q_m.z();
      for (int y = lo.y(); y <= hi.y(); ++y) {
        const float dy = (static_cast<float>(y) + 0.5F) * cell - q_m.y(), dyz = dy * dy + dz * dz;
        if (dyz > squared_reach) continue;
        for (int x = lo.x(); x <= hi.x(); ++x) {
          const float dx = (static_cast<float>(x) + 0.5F) * cell - q_m.x(), squared = dx * dx + dyz;
          if (squared > squared_reach) continue;
          const auto at = std::min(kBins - 1, static_cast<std::size_t>(bin * squared));
          cells[count] = layers.index(x, y, z);
          values[count++] = static_cast<std::int8_t>(nearness(squared, first_guess[at]));
        }
      }
    }
  }

  static constexpr std::size_t kBins = 64;  // of squared distance, for a first guess at a Gaussian
  float reach_m;
  std::array<float, kNear + 1> limits{};  ///< squared distances up to which a value is reached
  std::array<int, kBins> first_guess{};
  std::size_t count = 0;
  std::vector<std::size_t> cells;  ///< the first `count` of them, and their values
  std::vector<std::int8_t> values;
};

FieldLayers::FieldLayers(const Cloud& cloud_map, const std::vector<SightView>& views,
                         const FieldOptions& options, const Region& region) {
  lay_out(cloud_map, options, region);
  if (size_.isZero()) return;
  near_.assign((kAny + 1) * plane_cells(), 0);
  through_.assign(plane_cells(), 0);
  Stamp stamp(options.surface_sd_m);
  for (std::size_t i = 0; i < cloud_map.size(); ++i) add(cloud_map, i, &stamp);
  for (const SightView& view : views) count(view, nullptr);
}

FieldLayers::FieldLayers(const Cloud& cloud_map, const std::vector<SightView>& views,
                         const FieldOptions& options, const Earlier& earlier, const Region& region) {
  lay_out(cloud_map, options, region);
  const FieldLayers& before = earlier.layers;
  const bool same_cells =
      size_ == before.size_ && origin_ == before.origin_ && cell_ == before.cell_ && !size_.isZero();
  if (!same_cells || !earlier.change.little(cloud_map.size())) {
    *this = FieldLayers(cloud_map, views, options, region);
    return;
  }
  near_ = before.near_;
  Stamp stamp(options.surface_sd_m);
  for (const Eigen::Vector3f& p : earlier.change.gone) forget(p, &stamp);
  for (const std::uint32_t i : earlier.change.fresh) add(cloud_map, i, &stamp);
  const VoxelMask touched = VoxelMask::covering(earlier.change.gone, 2 * static_cast<double>(stamp.reach_m));
  for (std::size_t i = 0; i < cloud_map.size(); ++i)  // once more where something else was taken away
    if (touched.at(cloud_map.points[i])) add(cloud_map, i, &stamp);
  const bool same_sensors =
      std::ranges::equal(views, earlier.views, [](const auto& a, const auto& b) { return a.same_sensor(b); });
  if (same_sensors)
    through_ = before.through_;
  else
    through_.assign(plane_cells(), 0);
  for (std::size_t i = 0; i < views.size(); ++i)
    if (!same_sensors || !views[i].same_sight(earlier.views[i]))
      count(views[i], same_sensors ? &earlier.views[i] : nullptr);
}

void FieldLayers::lay_out(const Cloud& cloud_map, const FieldOptions& options, const Region& region) {
  region_ = region;
  Eigen::AlignedBox3d box;
  for (const auto& p : cloud_map.points)
    if (holds(region, p)) box.extend(p.cast<double>());
  if (box.isEmpty()) return;
  const auto volume = [&](double cell_m) { return (box.sizes().array() + 4 * cell_m).prod(); };
  const double cells = volume(options.cell_m) / std::pow(options.cell_m, 3);
  cell_ = cells > kMostCells ? options.cell_m * std::cbrt(cells / kMostCells) : options.cell_m;
  inverse_ = static_cast<float>(1.0 / cell_);
  const double snap_m = std::max(1.0, std::round(kSnap_m / cell_)) * cell_;
  const Eigen::Array3d low = (box.min().array() / snap_m).floor() * snap_m - 2 * cell_,
                       high = (box.max().array() / snap_m).ceil() * snap_m + 2 * cell_;
  origin_ = low.cast<float>();
  size_ = ((high - low) / cell_).round().cast<int>();
}

void FieldLayers::add(const Cloud& cloud_map, std::size_t i, Stamp* stamp) {
  if (!holds(region_, cloud_map.points[i])) return;
  stamp->take(*this, cloud_map.points[i]);
  const Eigen::Vector3f* normal = cloud_map.has_normals() ? &cloud_map.normals[i] : nullptr;
  for (int plane = 0; plane <= kAny; ++plane) {
    if (!enters(plane, normal)) continue;
    std::int8_t* cells = near_.data() + static_cast<std::size_t>(plane) * plane_cells();
    for (std::size_t k = 0; k < stamp->count; ++k)
      cells[stamp->cells[k]] = std::max(cells[stamp->cells[k]], stamp->values[k]);
  }
}

/// Also where the region has shrunk and does not hold it any more; what lies in others is out of reach.
void FieldLayers::forget(const Eigen::Vector3f& p_map, Stamp* stamp) {
  stamp->take(*this, p_map);
  for (int plane = 0; plane <= kAny; ++plane)
    for (std::size_t k = 0; k < stamp->count; ++k)
      near_[static_cast<std::size_t>(plane) * plane_cells() + stamp->cells[k]] = 0;
}

void FieldLayers::count(const SightView& view, const SightView* before) {
  const Eigen::AlignedBox3f box(origin_, origin_ + size_.cast<float>() * static_cast<float>(cell_));
  if (!view.reaches(box) && (before == nullptr || !before->reaches(box))) return;
  const auto cell = static_cast<float>(cell_), tolerance = static_cast<float>(0.5 * cell_ + 0.03);
  const auto centre = [&](int axis, int at) { return origin_[axis] + (static_cast<float>(at) + 0.5F) * cell; };
  const auto cells = static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y());
  Vectors layer(cells);
  for (std::size_t i = 0; i < cells; ++i) {
    const int at = static_cast<int>(i);
    layer.set(i, {centre(0, at % size_.x()), centre(1, at / size_.x()), 0.0F});
  }
  for (int z = 0; z < size_.z(); ++z) {
    std::ranges::fill(layer.z, centre(2, z));
    view.count_through(layer.run(0, cells), tolerance, before, through_.data() + index(0, 0, z));
  }
}

}  // namespace liloc
