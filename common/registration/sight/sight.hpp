#pragma once
// Free space seen along lines of sight: a depth sensor looks through empty space up to what it measures.
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "common/geometry/camera.hpp"
#include "common/geometry/cloud.hpp"
#include "common/registration/points/vectors.hpp"
#include "common/registration/sight/sight_kernel.hpp"

namespace liloc {

/// What a line of sight says of a point.
enum class Sight : std::uint8_t {
  unseen,    ///< outside the view, or nothing was measured there, or past the edge of something nearer
  agrees,    ///< a surface was measured at the point
  conflict,  ///< the sensor looked through the point: something there would have been seen
  behind     ///< hidden behind a measured surface
};

/// A depth sensor's measurement, thinned to bands: for each pixel of a small image the nearest and the farthest
/// depth measured in and around it. The bands keep a point beside an edge from counting as a conflict.
class SightView {
 public:
  SightView() = default;
  /// `factor` pixels of the image make one of the view. T_sensor_world places world points before the sensor.
  static SightView from_depth(const DepthImage& image, const Camera& camera, const Pose& T_sensor_world,
                              int factor, double max_range_m);
  /// Rebuilds the view of a device from its voxelized cloud (sensor frame): each voxel covers the pixels that
  /// its size covers, and past a voxel's edge nothing is looked through. Pixels without a point stay unseen.
  static SightView from_cloud(const Cloud& cloud_sensor, const Camera& camera, double voxel_size_m, int width);

  /// `p` in the world frame of the view; `tolerance_m` for agreeing, twice that for a conflict.
  [[nodiscard]] Sight look(const Eigen::Vector3f& p_world, float tolerance_m) const {
    return look_sensor(T_sensor_world_ * p_world, tolerance_m);
  }
  [[nodiscard]] Sight look_sensor(const Eigen::Vector3f& p, float tolerance_m) const {
    if (p.z() < kNearest) return Sight::unseen;
    const float inverse_z = 1.0F / p.z();
    const float u = p.x() * inverse_z * fx_ + cx_, v = p.y() * inverse_z * fy_ + cy_;
    if (!(u >= 0 && v >= 0 && u < width_f_ && v < height_f_)) return Sight::unseen;
    const auto pixel =
        static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u);
    return compare(bands_[pixel], p.z(), tolerance_m);
  }

  /// Whether a point of the sensor's frame can come into view by moving `margin_m`; may err towards yes.
  [[nodiscard]] bool may_see(const Eigen::Vector3f& p, float margin_m) const {
    const float z = p.z() + margin_m, u = p.x() * fx_ + cx_ * z, v = p.y() * fy_ + cy_ * z;
    const float slack_u = 2 * margin_m * fx_, slack_v = 2 * margin_m * fy_;
    return z > kNearest && u > -slack_u && u < width_f_ * z + slack_u && v > -slack_v &&
           v < height_f_ * z + slack_v;
  }

  struct Tally {
    int agree = 0, conflict = 0;
  };
  /// What `look_sensor` says of the points, counted; T_sensor_points places them before the sensor.
  [[nodiscard]] Tally tally(const PointRun& points, const Eigen::Isometry3f& T_sensor_points,
                            float tolerance_m) const;

  /// Raises each point's `Word` to what `look` says of it; `points` in the world frame of the view.
  void look_at_all(const PointRun& points_world, float tolerance_m, std::int32_t* words) const;
  /// The same of points on surfaces with these normals (world frame, zero where unknown): less is looked
  /// through where a line of sight grazes them, see `look_at`.
  void look_at_all(const PointRun& points_world, const PointRun& normals_world, float tolerance_m,
                   std::int32_t* words) const;

  /// Six half spaces of the points' frame: no ball that misses one of them holds a point that `tally` counts.
  [[nodiscard]] std::array<HalfSpace, 6> bounds(const Eigen::Isometry3f& T_sensor_points,
                                                float tolerance_m) const;

  /// Counts, for each of the points (world frame), whether it lies in space that was looked through; less those
  /// for which that was so `before`, in a view of the same sensor, if any.
  void count_through(const PointRun& points_world, float tolerance_m, const SightView* before,
                     std::uint8_t* counts) const;

  /// Whether anything in the box (world frame) may lie before what was measured; may err towards yes.
  [[nodiscard]] bool reaches(const Eigen::AlignedBox3f& box_world) const;

  /// Whether both are of one sensor at one place, and whether it also measured the same.
  [[nodiscard]] bool same_sensor(const SightView& other) const;
  [[nodiscard]] bool same_sight(const SightView& other) const {
    return same_sensor(other) && bands_ == other.bands_;
  }

  [[nodiscard]] bool empty() const { return bands_.empty(); }

 private:
  // In metres: under the least range of the sensors known (L515: 0.25 m; paper, section 3.1, Table 1).
  static constexpr float kNearest = 0.2F;
  using Band = DepthBand;
  [[nodiscard]] static Sight compare(const Band& band, float z, float tolerance_m) {
    if (band.far == 0) return Sight::unseen;
    const float slack = tolerance_m + 0.01F * z;
    if (z < band.edge - 2 * slack) return Sight::conflict;
    const bool at_near = z >= band.near - 2 * slack && z <= band.near + slack,
               at_far = z >= band.far - slack && z <= band.far + slack;
    return at_near || at_far ? Sight::agrees : z < band.near ? Sight::unseen : Sight::behind;
  }
  void prepare(const Camera& small);
  [[nodiscard]] Pinhole pinhole(const Eigen::Isometry3f& T_sensor_points) const;
  void widen();  ///< takes in the bands of the four neighbours
  template <class Visit>
  void for_each_pixel_near(const Eigen::Vector3f& p_sensor, float reach_m, const Visit& visit);

  Eigen::Isometry3f T_sensor_world_ = Eigen::Isometry3f::Identity();
  int width_ = 0, height_ = 0;
  float width_f_ = 0, height_f_ = 0, fx_ = 1, fy_ = 1, cx_ = 0, cy_ = 0;  ///< centre shifted by half a pixel
  float farthest_ = 0;                                                    ///< that was measured
  std::vector<Band> bands_;  ///< pixel by pixel, and one that measured nothing
};

}  // namespace liloc
