#pragma once
#include <cstdint>
#include <vector>

#include "common/base/stamp.hpp"
#include "common/geometry/camera.hpp"
#include "common/registration/points/surfels.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct LocalMapOptions {
  double cell_m = 0.10;              ///< one surfel per cell
  std::size_t max_surfels = 40'000;  ///< memory bound (about 100 bytes each); the longest unseen go first
  float full_weight = 800;  ///< points after which a surfel stays as it is: early ones anchor the odometry
  StampNs trust_after_ns = from_ms(500);  ///< younger surfels may be people: they count less
  int refuted_after = 2;                  ///< views through a surfel that remove it
};

/// What the device has seen around it, in its odometry frame: a surfel per cell, bounded in memory. What moves
/// is removed as soon as a later frame looks through it. Not thread-safe while it changes.
class LocalMap {
 public:
  struct Cell {
    Surfel surfel;  ///< odometry frame
    StampNs first_ns = 0, last_ns = 0;
    int views = 0;
    int refuted = 0;
  };

  explicit LocalMap(const LocalMapOptions& options = {});

  /// Merges a frame's surfels (sensor frame) seen from T_map_sensor.
  void insert(const Pose& T_map_sensor, const std::vector<Surfel>& frame, StampNs stamp_ns);
  /// Removes what the depth image looks through. Paid per map surfel: about 10 ns each.
  void carve(const Pose& T_map_sensor, const DepthImage& image, const Camera& camera, double max_range_m);

  /// How the map's surfels in view relate to a depth image taken from T_map_sensor.
  struct View {
    int agree = 0;    ///< seen at their depth
    int through = 0;  ///< the image looks through them: they have moved, or the pose is wrong
    int hidden = 0;   ///< something stands before them
    /// Share of those that should be visible and are not.
    [[nodiscard]] double refuted_share() const {
      return agree + through == 0 ? 1.0 : static_cast<double>(through) / (agree + through);
    }
  };
  [[nodiscard]] View compare(const Pose& T_map_sensor, const DepthImage& image, const Camera& camera,
                             double max_range_m) const;

  /// The nearest surfel among the cells up to `reach` cells from `p` on each side whose normal is within 45
  /// degrees of `normal`, both in the map frame; null when there is none. Reach 1 looks into eight cells, 2
  /// into 64.
  [[nodiscard]] const Cell* find(const Eigen::Vector3f& p, const Eigen::Vector3f& normal, int reach = 1) const;
  /// 1 for a surfel that has stood the test of time, `kYoungWeight` before.
  [[nodiscard]] float trust(const Cell& cell, StampNs now_ns) const;

  /// Means and normals, for feature matching.
  [[nodiscard]] Cloud cloud() const;
  /// The same of those that have stood the test of time and were seen at `since_ns` or later.
  [[nodiscard]] Cloud standing(StampNs since_ns, StampNs now_ns) const;
  [[nodiscard]] std::size_t size() const { return alive_; }
  [[nodiscard]] double cell_m() const { return options_.cell_m; }

  static constexpr float kYoungWeight = 0.2F;  ///< by hand

 private:
  [[nodiscard]] std::uint32_t lookup(std::uint64_t key) const;
  void add(std::uint64_t key, const Surfel& surfel, StampNs stamp_ns);
  void merge(Cell& cell, const Surfel& surfel, const Eigen::Vector3f& sensor, StampNs stamp_ns);
  void trim(StampNs stamp_ns);
  void rebuild(std::size_t slots);

  LocalMapOptions options_;
  float inverse_;
  std::vector<Cell> cells_;  ///< count 0 marks a removed one
  std::vector<std::uint64_t> cell_keys_;
  std::vector<std::uint64_t> keys_;  ///< open addressing; parallel to slots_
  std::vector<std::uint32_t> slots_;
  int shift_ = 0;
  std::size_t alive_ = 0;
};

}  // namespace liloc
