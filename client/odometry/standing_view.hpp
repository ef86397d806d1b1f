#pragma once
#include <optional>
#include <vector>

#include "client/odometry/range_noise.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct StandingOptions {
  int tile_px = 16;               ///< side of the squares that are judged together
  float deviations = 3;           ///< of the noise, within which a pixel has not changed
  double min_share = 0.25;        ///< of the pixels with a return in both frames that have not changed
  int min_tiles = 10;             ///< unchanged ones, in at least three quarters of the image
  double min_agree = 0.5;         ///< of the unchanged squares and edges that have not shifted,
  double min_agree_least = 0.05;  ///< and of what shows a motion along any axis: 0.02 to 0.04 of devices that
                                  ///< moved by 3 cm, 0.06 and more of those that stood beside walkers
  double most_sd_m = 0.010;       ///< what must be known of a motion along any axis; a radian counts as 2 m
  double moved_m = 0.003;         ///< a motion beyond, if it is significant, is none of a device that stands,
  double moved_rad = 0.0017;      ///< (0.1 degrees)
  double significant = 22.5;      ///< which is, that so much of the squared deviations is explained by it:
                                  ///< chi-square of six, one in a thousand
};

/// What a frame says, pixel by pixel, of the motion since a reference frame.
struct StandingCheck {
  bool stands = false;
  bool moved = false;      ///< surely; where neither is sure the frame shows too little
  double share = 0;        ///< of the pixels with a return in both that have not changed
  int tiles = 0;           ///< unchanged ones
  int edges = 0;           ///< squares with depth edges that were seen again
  double sd_m = 0;         ///< along the axis that is known least; a radian counts as 2 m
  double agree = 0;        ///< share of what is unchanged that has not shifted
  double agree_least = 0;  ///< the same, along the axis where the least of what shows a motion has not
  double explained = 0;    ///< squared deviations that the motion explains and standing does not
  Vector6d motion = Vector6d::Zero();       ///< T_reference_now to first order, [rad; m], sensor axes
  Matrix6d information = Matrix6d::Zero();  ///< of it
};

/// Tells a device that stands from one that moves by what does not change in its view, whoever walks by:
/// surfaces whose depth is the same, and depth edges that stay at their pixels, which hold what bare surfaces
/// leave open. All frames are compared with one reference, so that a slow motion adds up until it shows.
/// Not thread-safe.
class StandingView {
 public:
  explicit StandingView(const Camera& camera, const StandingOptions& options = {});

  /// Learns the noise; to be called for each frame, after `compare`.
  void next(const DepthImage& image);
  /// The newest frame given to `next` becomes the reference; its pose was measured.
  void refer(const Pose& T_odom_sensor);
  void forget() { reference_.units.clear(); }
  [[nodiscard]] bool has_reference() const { return !reference_.units.empty(); }
  [[nodiscard]] const Pose& T_odom_reference() const { return T_odom_reference_; }
  /// There must be a reference.
  [[nodiscard]] StandingCheck compare(const DepthImage& image);

 private:
  /// A square of the reference image that is flat.
  struct Tile {
    int u = 0, v = 0;  ///< of its first pixel
    bool flat = false;
    Eigen::Vector3d mean, normal;  ///< sensor axes
    double normal_variance = 0;    ///< rad^2
  };
  /// Where the reference's depth has an edge between two pixels, two apart.
  struct Edge {
    std::uint32_t near, far;  ///< indices of pixels
    int tile;
    std::uint8_t gap;  ///< pixels
    bool upright;      ///< the edge is crossed along u
    bool far_after;    ///< the far pixel is the one to the right, or below
  };
  struct Evidence;

  [[nodiscard]] Eigen::Vector3d ray_of(int u, int v) const {
    return {(u - camera_.cx) / camera_.fx, (v - camera_.cy) / camera_.fy, 1};
  }
  void prepare();
  [[nodiscard]] Tile fit_tile(int u, int v) const;
  void find_edges();
  [[nodiscard]] bool same(std::uint16_t before, int after) const;
  void gather_surfaces(const DepthImage& image, std::vector<Evidence>& rows, StandingCheck& check,
                       double& normal_noise) const;
  void solve(std::vector<Evidence>& rows, StandingCheck& check) const;
  void gather_edges(const DepthImage& image, std::vector<Evidence>& rows) const;

  Camera camera_;
  StandingOptions options_;
  RangeNoise noise_;
  DepthImage newest_, reference_;
  Pose T_odom_reference_ = Pose::Identity();
  double prepared_for_ = 0;  ///< noise for which tiles and edges are the reference's; 0: they are not
  std::vector<Tile> tiles_;
  std::vector<Edge> edges_;
  bool edges_found_ = false;
};

}  // namespace liloc
