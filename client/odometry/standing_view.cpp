#include "client/odometry/standing_view.hpp"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace liloc {
namespace {

using Matrix36d = Eigen::Matrix<double, 3, 6>;

// Every eighth pixel in both axes tells a device that surely moves; where nothing else is said: by hand.
constexpr int kCoarse = 8;
constexpr double kCoarseShare = 0.7;  // of the share that is asked for
constexpr double kQuieter = 0.8;      // less noise than before shows more edges and fewer flat squares
constexpr int kFewestPixels = 24;     // of a tile, that make a plane
constexpr double kTileSdM = 0.002;    // common to a tile: fixed patterns, drift with temperature; by hand,
constexpr double kTileShare = 0.25;   // and so much of the noise, as neighbouring pixels err alike
constexpr double kEdgePx = 1.0;       // noise of a pair at an edge, and what pairs of a tile have in common;
constexpr double kEdgeTilePx = 0.25;  // by hand
constexpr double kFewestPairs = 4;    // of a tile, that show an edge
constexpr int kWidestGap = 8;         // without returns: behind the rim of what stands a camera sees nothing
constexpr int kEdgeGap = 2;           // pixels: between them may lie a mixed one
constexpr float kEdgeDeviations = 6, kEdgeShare = 0.03F;  // of an edge: of noise, and of the range
constexpr double kLeverM = 2;    // at which a turn counts as a shift (ScanMatchOptions has the same)
constexpr double kAgree = 3;     // deviations from standing still, beyond which a square shows something else
constexpr double kFaint = 1e-3;  // information that keeps the solver from dividing by 0
constexpr double kNormalNoise = 3;  // what noisy normals feign, times so much, is no knowledge

/// Change of a standing point's coordinates by a motion of the sensor, [rotation; translation].
Matrix36d point_by_motion(const Eigen::Vector3d& p) {
  Matrix36d D;
  D << skew(p), -Eigen::Matrix3d::Identity();
  return D;
}

}  // namespace

/// One number that was measured: what the motion explains of it, J motion = value.
struct StandingView::Evidence {
  Vector6d J = Vector6d::Zero();
  double value = 0, sd = 1;
};

StandingView::StandingView(const Camera& camera, const StandingOptions& options)
    : camera_(camera), options_(options), noise_(camera.depth_scale_m) {}

void StandingView::next(const DepthImage& image) {
  if (newest_.units.size() == image.units.size()) noise_.learn(newest_, image);
  newest_ = image;
}

void StandingView::refer(const Pose& T_odom_sensor) {
  reference_ = newest_;
  T_odom_reference_ = T_odom_sensor;
  prepared_for_ = 0;
}

bool StandingView::same(std::uint16_t before, int after) const {
  return static_cast<float>(std::abs(static_cast<int>(before) - after)) <=
         options_.deviations * noise_.sd_units(before);
}

StandingView::Tile StandingView::fit_tile(int u0, int v0) const {
  Tile tile{.u = u0, .v = v0, .mean = Eigen::Vector3d::Zero(), .normal = Eigen::Vector3d::UnitZ()};
  const double scale = camera_.depth_scale_m;
  // A plane is linear in the image: 1 / z = normal . (x, y, 1) / distance.
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double count = 0;
  const auto each_point = [&](const auto& use) {
    for (int v = v0; v < v0 + options_.tile_px; ++v)
      for (int u = u0; u < u0 + options_.tile_px; ++u)
        if (const std::uint16_t depth = reference_.at(u, v); depth > 0)
          use(Eigen::Vector3d(depth * scale * ray_of(u, v)));
  };
  each_point([&](const Eigen::Vector3d& p) {
    A += p * p.transpose();  // an error of z is one of 1 / z times z^2
    b += p;
    count += 1;
  });
  if (count < kFewestPixels) return tile;
  tile.mean = b / count;
  const Eigen::Vector3d plane = A.ldlt().solve(b);
  if (!plane.allFinite() || plane.norm() < 1e-6) return tile;
  tile.normal = plane.normalized();
  double squares = 0;
  each_point([&](const Eigen::Vector3d& p) { squares += std::pow(tile.normal.dot(p) - 1 / plane.norm(), 2); });
  const double rms = std::sqrt(squares / count);
  const double sd = noise_.sd_units(static_cast<std::uint16_t>(tile.mean.z() / scale)) * scale;
  const double half = 0.5 * options_.tile_px * tile.mean.z() / camera_.fx;
  tile.normal_variance = rms * rms / (count * half * half / 3);
  tile.flat = rms <= 1.5 * sd * std::max(0.3, std::abs(tile.normal.dot(tile.mean.normalized())));
  return tile;
}

void StandingView::find_edges() {
  edges_.clear();
  edges_found_ = true;
  const int width = reference_.width, height = reference_.height;
  const int columns = (width + options_.tile_px - 1) / options_.tile_px;
  const auto look = [&](int u, int v, bool upright) {
    const int step = upright ? 1 : width, room = (upright ? width - u : height - v) - 1;
    const int a = reference_.at(u, v), index = v * width + u;
    int gap = kEdgeGap;
    while (gap < std::min(kWidestGap, room) &&
           reference_.units[static_cast<std::size_t>(index + gap * step)] == 0)
      ++gap;
    if (a == 0 || gap > room) return;
    const int b = reference_.units[static_cast<std::size_t>(index + gap * step)];
    if (b == 0) return;
    const auto height_units = static_cast<float>(std::abs(a - b)), farther = static_cast<float>(std::max(a, b));
    if (height_units < kEdgeShare * farther ||
        height_units < kEdgeDeviations * noise_.sd_units(static_cast<std::uint16_t>(std::max(a, b))))
      return;
    const auto first = static_cast<std::uint32_t>(v * width + u),
               second = static_cast<std::uint32_t>(index + gap * step);
    const int tile = v / options_.tile_px * columns + u / options_.tile_px;
    edges_.push_back(
        {a < b ? first : second, a < b ? second : first, tile, static_cast<std::uint8_t>(gap), upright, a < b});
  };
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      look(u, v, true);
      look(u, v, false);
    }
}

void StandingView::prepare() {
  prepared_for_ = noise_.total();
  tiles_.clear();
  for (int v = 0; v + options_.tile_px <= reference_.height; v += options_.tile_px)
    for (int u = 0; u + options_.tile_px <= reference_.width; u += options_.tile_px)
      tiles_.push_back(fit_tile(u, v));
  edges_found_ = false;
}

void StandingView::gather_surfaces(const DepthImage& image, std::vector<Evidence>& rows, StandingCheck& check,
                                   double& normal_noise) const {
  const double scale = camera_.depth_scale_m;
  double all = 0, unchanged = 0;
  int quarters[4] = {0, 0, 0, 0};
  for (const Tile& tile : tiles_) {
    int both = 0, kept = 0;
    double sum = 0;
    for (int v = tile.v; v < tile.v + options_.tile_px; ++v)
      for (int u = tile.u; u < tile.u + options_.tile_px; ++u) {
        const std::uint16_t before = reference_.at(u, v);
        const int after = image.at(u, v);
        if (before == 0 || after == 0) continue;
        ++both;
        if (!same(before, after)) continue;
        ++kept;
        sum += after - before;
      }
    all += both;
    unchanged += kept;
    if (kept < kFewestPixels || 2 * kept < both) continue;
    ++check.tiles;
    ++quarters[(tile.u * 2 >= image.width ? 1 : 0) + (tile.v * 2 >= image.height ? 2 : 0)];
    if (!tile.flat) continue;
    const double slant = tile.normal.dot(tile.mean) / tile.mean.z();
    const double sd = noise_.sd_units(static_cast<std::uint16_t>(tile.mean.z() / scale)) * scale * slant;
    Evidence row;
    row.J = (tile.normal.transpose() * point_by_motion(tile.mean)).transpose();
    row.value = sum / kept * scale * slant;
    row.sd = std::hypot(sd / std::sqrt(kept), kTileSdM, kTileShare * sd);
    normal_noise += tile.normal_variance / (row.sd * row.sd);
    rows.push_back(row);
  }
  check.share = all > 0 ? unchanged / all : 0;
  if (std::count_if(quarters, quarters + 4, [](int count) { return count > 0; }) < 3) check.tiles = 0;
}

void StandingView::gather_edges(const DepthImage& image, std::vector<Evidence>& rows) const {
  struct Sum {
    Vector6d J = Vector6d::Zero();
    double value = 0, weight = 0;
  };
  const int columns = (image.width + options_.tile_px - 1) / options_.tile_px;
  const int lines = (image.height + options_.tile_px - 1) / options_.tile_px;
  std::vector<Sum> sums(static_cast<std::size_t>(2 * columns * lines));
  for (const Edge& edge : edges_) {
    const std::uint16_t near = reference_.units[edge.near], far = reference_.units[edge.far];
    const int near_now = image.units[edge.near], far_now = image.units[edge.far];
    double moved = 0;  // pixels, towards the far side
    if (same(near, near_now) && same(far, far_now))
      moved = 0;
    else if (same(near, near_now) && same(near, far_now))
      moved = edge.gap;
    else if (same(far, near_now) && same(far, far_now))
      moved = -edge.gap;
    else
      continue;  // something else stands there now
    const int u = static_cast<int>(edge.near) % image.width, v = static_cast<int>(edge.near) / image.width;
    const double z = near * camera_.depth_scale_m;
    const Eigen::Vector3d ray = ray_of(u, v);
    const Matrix36d D = point_by_motion(z * ray);
    Sum& sum = sums[static_cast<std::size_t>(2 * edge.tile + (edge.upright ? 1 : 0))];
    const double weight =
        std::pow(kEdgeGap / static_cast<double>(edge.gap), 2);  // its noise grows with the gap
    sum.J += weight * (edge.upright ? camera_.fx / z * (D.row(0) - ray.x() * D.row(2))
                                    : camera_.fy / z * (D.row(1) - ray.y() * D.row(2)))
                          .transpose();
    sum.value += weight * (edge.far_after ? moved : -moved);
    sum.weight += weight;
  }
  for (const Sum& sum : sums)
    if (sum.weight >= kFewestPairs)
      rows.push_back({sum.J / sum.weight, sum.value / sum.weight,
                      std::sqrt(kEdgePx * kEdgePx / sum.weight + kEdgeTilePx * kEdgeTilePx)});
}

/// Of what agrees with standing still, so that a person's edges, as consistent among themselves, do not take
/// the device along: of a device that moves hardly anything that shows the motion agrees.
void StandingView::solve(std::vector<Evidence>& rows, StandingCheck& check) const {
  const auto count = static_cast<double>(std::max<std::size_t>(rows.size(), 1));
  Matrix6d all = kFaint * Matrix6d::Identity();
  for (const Evidence& row : rows) all += row.J * row.J.transpose() / (row.sd * row.sd);
  std::erase_if(rows, [](const Evidence& row) { return std::abs(row.value) > kAgree * row.sd; });
  check.information = kFaint * Matrix6d::Identity();
  Vector6d b = Vector6d::Zero();
  double squares = 0;
  for (const Evidence& row : rows) {
    check.information += row.J * row.J.transpose() / (row.sd * row.sd);
    b += row.J * row.value / (row.sd * row.sd);
    squares += row.value * row.value / (row.sd * row.sd);
  }
  // Along the axis where the most of what would show a motion does not agree.
  check.agree = static_cast<double>(rows.size()) / count;
  check.agree_least =
      Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d>(check.information, all, Eigen::EigenvaluesOnly)
          .eigenvalues()[0];
  check.motion = check.information.ldlt().solve(b);
  const double explained = b.dot(check.motion);
  // Where others move, what is left is more than noise, and so is what chance explains.
  check.explained = explained / std::max(1.0, (squares - explained) /
                                                  static_cast<double>(std::max<std::size_t>(rows.size(), 1)));
  const bool near =
      check.motion.head<3>().norm() <= options_.moved_rad && check.motion.tail<3>().norm() <= options_.moved_m;
  check.moved = check.agree < options_.min_agree || (!near && check.explained > options_.significant);
}

StandingCheck StandingView::compare(const DepthImage& image) {
  StandingCheck check;
  int both = 0, kept = 0;
  for (int v = kCoarse / 2; v < image.height; v += kCoarse)
    for (int u = kCoarse / 2; u < image.width; u += kCoarse) {
      const std::uint16_t before = reference_.at(u, v), after = image.at(u, v);
      if (before == 0 || after == 0) continue;
      ++both;
      kept += same(before, after);
    }
  check.share = both > 0 ? static_cast<double>(kept) / both : 0;
  check.moved = check.share < kCoarseShare * options_.min_share;
  if (check.moved) return check;
  if (noise_.total() < kQuieter * prepared_for_ || prepared_for_ == 0) prepare();
  std::vector<Evidence> rows;
  double normal_noise = 0;
  gather_surfaces(image, rows, check, normal_noise);
  check.moved = check.share < options_.min_share;
  if (check.moved || check.tiles < options_.min_tiles) return check;
  std::vector<Evidence> surfaces = rows;
  solve(surfaces, check);
  if (check.moved) return check;  // edges tell nothing else
  if (!edges_found_) find_edges();
  gather_edges(image, rows);
  solve(rows, check);
  Vector6d unit = Vector6d::Ones();
  unit.head<3>() /= kLeverM;
  const Matrix6d scaled = unit.asDiagonal() * check.information * unit.asDiagonal();
  const double known = Eigen::SelfAdjointEigenSolver<Matrix6d>(scaled, Eigen::EigenvaluesOnly).eigenvalues()[0];
  check.sd_m = 1 / std::sqrt(std::max(known - kNormalNoise * normal_noise, 1e-6));
  check.stands =
      !check.moved && check.agree_least >= options_.min_agree_least && check.sd_m <= options_.most_sd_m;
  return check;
}

}  // namespace liloc
