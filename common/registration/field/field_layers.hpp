#pragma once
#include <cstdint>
#include <vector>

#include "common/geometry/cloud.hpp"
#include "common/geometry/regions.hpp"
#include "common/registration/points/cloud_change.hpp"
#include "common/registration/sight/sight.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct FieldOptions {
  double cell_m = 0.1;
  double surface_sd_m = 0.08;  ///< how far from a surface its worth reaches, as a Gaussian
  int free = -10;              ///< worth of space that the ceiling looked through
  int pad = 0;                 ///< cells of zeros at both ends of a row
};

/// What a score field is made of: how near the surfaces are at each place, by the way they face, and how many
/// ceiling sensors look through it. From the layers of a room those of the next are made where it changed.
class FieldLayers {
 public:
  static constexpr int kNear = 15;  ///< on a surface; eight fit a byte, RowSums
  static constexpr int kAzimuths = 8, kUp = 8, kDown = 9, kDirections = 10;  ///< 45 degrees each; by hand
  static constexpr int kAny = 10;  ///< the plane of surfaces that face anywhere

  FieldLayers() = default;
  /// `cloud` in the map frame, at most a cell apart on surfaces; without normals it faces everywhere. Only what
  /// lies in the region counts.
  FieldLayers(const Cloud& cloud_map, const std::vector<SightView>& views, const FieldOptions& options,
              const Region& region = everywhere());

  /// The room that other layers were made of, and what became of its cloud.
  struct Earlier {
    const FieldLayers& layers;  ///< by the same options
    const std::vector<SightView>& views;
    const CloudChange& change;
  };
  /// The same layers, to the last bit, sooner.
  FieldLayers(const Cloud& cloud_map, const std::vector<SightView>& views, const FieldOptions& options,
              const Earlier& earlier, const Region& region = everywhere());

  [[nodiscard]] bool empty() const { return near_.empty(); }
  [[nodiscard]] double cell_m() const { return cell_; }
  [[nodiscard]] const Eigen::Vector3f& origin() const { return origin_; }  ///< corner of cell (0,0,0)
  [[nodiscard]] const Eigen::Vector3i& size() const { return size_; }      ///< cells
  /// A row of cells, x = 0 first: 0 (no surface in reach) .. kNear.
  [[nodiscard]] const std::int8_t* near(int y, int z, int plane) const {
    return near_.data() + static_cast<std::size_t>(plane) * plane_cells() + index(0, y, z);
  }
  /// The same row: how many sensors look through.
  [[nodiscard]] const std::uint8_t* through(int y, int z) const { return through_.data() + index(0, y, z); }

 private:
  struct Stamp;
  [[nodiscard]] std::size_t plane_cells() const { return index(0, 0, size_.z()); }
  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(x);
  }
  void lay_out(const Cloud& cloud_map, const FieldOptions& options, const Region& region);
  void add(const Cloud& cloud_map, std::size_t i, Stamp* stamp);
  void forget(const Eigen::Vector3f& p_map, Stamp* stamp);
  void count(const SightView& view, const SightView* before);

  Region region_;
  double cell_ = 0;
  float inverse_ = 1;
  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero();
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::vector<std::int8_t> near_;      ///< plane by plane, x fastest
  std::vector<std::uint8_t> through_;  ///< of one plane
};

}  // namespace liloc
