#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/registration/field/field_layers.hpp"
#include "common/registration/points/voxel_mask.hpp"

namespace liloc {

/// What a device point is worth at each place of the room: up to kSurface on a measured surface that faces the
/// same way, the more the rarer such surfaces are at that height (floor is everywhere and says little); 0 where
/// nobody looked or the surface faces another way; `free` where the ceiling looked through empty space. There
/// is one plane of such cells per direction that a surface can face, so that a pose scores by one look-up per
/// device point, normals and free space included. x runs fastest; outside the field all is 0.
class ScoreField {
 public:
  static constexpr int kSurface = FieldLayers::kNear, kAzimuths = FieldLayers::kAzimuths,
                       kUp = FieldLayers::kUp, kDown = FieldLayers::kDown,
                       kDirections = FieldLayers::kDirections;
  static constexpr int kAny =
      FieldLayers::kAny;  ///< surfaces of every direction, all worth kSurface; free space -kSurface

  /// The plane for a surface with this unit normal (map axes).
  [[nodiscard]] static int plane_of(const Eigen::Vector3f& normal_map);

  ScoreField() = default;
  ScoreField(const FieldLayers& layers, const FieldOptions& options);
  ScoreField(const Cloud& cloud_map, const std::vector<SightView>& views, const FieldOptions& options)
      : ScoreField(FieldLayers(cloud_map, views, options), options) {}

  [[nodiscard]] int at(const Eigen::Vector3f& p_map, int plane) const {
    const Eigen::Vector3f q = (p_map - origin_) * inverse_;
    if (!((q.array() >= 0).all() && (q.array() < extent_.array()).all())) return 0;
    return cells_[index(static_cast<int>(q.x()), static_cast<int>(q.y()), static_cast<int>(q.z()), plane)];
  }

  /// Points as arrays, and the plane that each is looked up in.
  struct Probes {
    std::vector<float> x, y, z;
    std::vector<std::int32_t> plane;
  };
  /// What the first of the probes, one per `worths`, are worth when they are shifted: `at` for many points.
  void look_up(const Probes& probes, const Eigen::Vector3f& shift, std::span<std::int32_t> worths) const;

  /// Makes free space unknown where somebody moves: the field is of the still room and calls it empty.
  void forget_free_space(const VoxelMask& dynamic_mask);

  [[nodiscard]] bool empty() const { return cells_.empty(); }
  [[nodiscard]] double cell_m() const { return cell_; }
  [[nodiscard]] int pad() const { return pad_; }
  [[nodiscard]] const Eigen::Vector3f& origin() const { return origin_; }  ///< corner of cell (0,0,0)
  [[nodiscard]] const Eigen::Vector3i& size() const { return size_; }      ///< cells
  [[nodiscard]] int stride() const { return stride_; }                     ///< cells from a row to the next
  /// The cell x = 0 of a row; x may run from -pad to size + pad + 31.
  [[nodiscard]] const std::int8_t* row(int y, int z, int plane) const {
    return cells_.data() + index(0, y, z, plane);
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y, int z, int plane) const {
    const auto row =
        (static_cast<std::size_t>(plane) * static_cast<std::size_t>(size_.z()) + static_cast<std::size_t>(z)) *
            static_cast<std::size_t>(size_.y()) +
        static_cast<std::size_t>(y);
    return row * static_cast<std::size_t>(stride_) + static_cast<std::size_t>(x + pad_);
  }
  void take_layer(const FieldLayers& layers, int z, int free);

  double cell_ = 0;
  float inverse_ = 1;
  int pad_ = 0, stride_ = 0;
  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero(), extent_ = Eigen::Vector3f::Zero();
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::vector<std::int8_t> cells_;
};

}  // namespace liloc
