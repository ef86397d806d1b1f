#include "common/registration/sight/sight.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/registration/points/simd.hpp"

namespace liloc {

namespace {

constexpr std::size_t kAtOnce = 512;  // points whose words are kept before they are counted

constexpr std::uint16_t kNoDepth = 65535;  // beyond any depth

// In voxels: how far a thinned point covers its surface, and how far from it a point of the other cloud may lie
// that is the same surface's. Between 0.6 and 2, DECISIONS.md.
constexpr double kCovers = 0.6, kEdge = 1.2;

/// Takes a row of depths into the nearest and farthest of each column; 0 and what is too far are left out.
LILOC_WIDEST void take_row(const std::uint16_t* units, std::uint16_t farthest, std::size_t count,
                           std::uint16_t* near, std::uint16_t* far) {
#pragma omp simd
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint16_t value = units[i] > farthest ? std::uint16_t{0} : units[i];
    const std::uint16_t nearer = value == 0 ? kNoDepth : value;
    near[i] = near[i] < nearer ? near[i] : nearer;
    far[i] = far[i] > value ? far[i] : value;
  }
}

}  // namespace

void SightView::prepare(const Camera& small) {
  width_ = small.width;
  height_ = small.height;
  width_f_ = static_cast<float>(width_);
  height_f_ = static_cast<float>(height_);
  fx_ = static_cast<float>(small.fx);
  fy_ = static_cast<float>(small.fy);
  cx_ = static_cast<float>(small.cx + 0.5);  // so that truncation picks the nearest pixel
  cy_ = static_cast<float>(small.cy + 0.5);
  bands_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) + 1, Band{});
}

SightView SightView::from_depth(const DepthImage& image, const Camera& camera, const Pose& T_sensor_world,
                                int factor, double max_range_m) {
  SightView view;
  view.prepare(shrunk(camera, factor));
  view.T_sensor_world_ = T_sensor_world.cast<float>();
  const auto scale = static_cast<float>(camera.depth_scale_m);
  const auto farthest =
      static_cast<std::uint16_t>(std::min(65534.0F, std::floor(static_cast<float>(max_range_m) / scale)));
  const auto width = static_cast<std::size_t>(image.width);
  std::vector<std::uint16_t> near(width), far(width);
  for (int v = 0; v < image.height; v += factor) {
    std::ranges::fill(near, kNoDepth);
    std::ranges::fill(far, std::uint16_t{0});
    for (int row = v; row < std::min(v + factor, image.height); ++row)
      take_row(image.units.data() + static_cast<std::size_t>(row) * width, farthest, width, near.data(),
               far.data());
    Band* bands = view.bands_.data() + static_cast<std::ptrdiff_t>(v / factor) * view.width_;
    for (std::size_t u = 0; u < width; u += static_cast<std::size_t>(factor)) {
      const std::size_t end = std::min(u + static_cast<std::size_t>(factor), width);
      const std::uint16_t least = *std::min_element(&near[u], near.data() + end),
                          most = *std::max_element(&far[u], far.data() + end);
      if (most > 0)
        bands[u / static_cast<std::size_t>(factor)] = {static_cast<float>(least) * scale,
                                                       static_cast<float>(most) * scale,
                                                       static_cast<float>(least) * scale};
    }
  }
  view.widen();
  for (const Band& band : view.bands_) view.farthest_ = std::max(view.farthest_, band.far);
  return view;
}

template <class Visit>
void SightView::for_each_pixel_near(const Eigen::Vector3f& p, float reach_m, const Visit& visit) {
  const float u = p.x() / p.z() * fx_ + cx_, v = p.y() / p.z() * fy_ + cy_;
  const float reach_u = reach_m / p.z() * fx_, reach_v = reach_m / p.z() * fy_;
  const int u0 = std::max(0, static_cast<int>(std::floor(u - reach_u)));
  const int u1 = std::min(width_ - 1, static_cast<int>(std::floor(u + reach_u)));
  const int v0 = std::max(0, static_cast<int>(std::floor(v - reach_v)));
  const int v1 = std::min(height_ - 1, static_cast<int>(std::floor(v + reach_v)));
  for (int y = v0; y <= v1; ++y)
    for (int x = u0; x <= u1; ++x)
      visit(&bands_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(x)]);
}

SightView SightView::from_cloud(const Cloud& cloud_sensor, const Camera& camera, double voxel_size_m,
                                int width) {
  SightView view;
  view.prepare(shrunk(camera, std::max(1, (camera.width + width - 1) / width)));
  for (const Eigen::Vector3f& p : cloud_sensor.points) {
    if (p.z() < kNearest) continue;
    const float z = p.z();
    view.for_each_pixel_near(p, static_cast<float>(kCovers * voxel_size_m), [z](Band* band) {
      band->near = band->far == 0 ? z : std::min(band->near, z);
      band->far = std::max(band->far, z);
    });
    view.for_each_pixel_near(p, static_cast<float>(kEdge * voxel_size_m),
                             [z](Band* band) { band->edge = band->edge == 0 ? z : std::min(band->edge, z); });
  }
  for (const Band& band : view.bands_) view.farthest_ = std::max(view.farthest_, band.far);
  return view;
}

Pinhole SightView::pinhole(const Eigen::Isometry3f& T_sensor_points) const {
  Pinhole camera{{}, {}, fx_, fy_, cx_, cy_, width_f_, height_f_, kNearest, 0};
  camera.none = static_cast<std::int32_t>(bands_.size()) - 1;
  Eigen::Map<Eigen::Matrix3f>(camera.R) = T_sensor_points.linear();
  Eigen::Map<Eigen::Vector3f>(camera.t) = T_sensor_points.translation();
  return camera;
}

namespace {

/// Calls visit(first point, how many, their words) for a run of points after another.
template <class Visit>
void for_each_run(const Pinhole& camera, const DepthBand* bands, const PointRun& points, float tolerance_m,
                  const Visit& visit) {
  std::array<std::int32_t, kAtOnce> words;
  for (std::size_t begin = 0; begin < points.count; begin += kAtOnce) {
    const std::size_t here = std::min(kAtOnce, points.count - begin);
    std::fill_n(words.begin(), here, kNoWord);
    look_at(camera, bands, {points.x + begin, points.y + begin, points.z + begin, here}, tolerance_m,
            words.data());
    visit(begin, here, words.data());
  }
}

}  // namespace

SightView::Tally SightView::tally(const PointRun& points, const Eigen::Isometry3f& T_sensor_points,
                                  float tolerance_m) const {
  Tally tally;
  for_each_run(pinhole(T_sensor_points), bands_.data(), points, tolerance_m,
               [&](std::size_t, std::size_t count, const std::int32_t* words) {
                 for (std::size_t i = 0; i < count; ++i) {
                   tally.agree += words[i] == kMeasured;
                   tally.conflict += words[i] == kLookedThrough;
                 }
               });
  return tally;
}

void SightView::look_at_all(const PointRun& points_world, float tolerance_m, std::int32_t* words) const {
  look_at(pinhole(T_sensor_world_), bands_.data(), points_world, tolerance_m, words);
}

void SightView::count_through(const PointRun& points_world, float tolerance_m, const SightView* before,
                              std::uint8_t* counts) const {
  const auto add = [&](const SightView& view, int sign) {
    for_each_run(view.pinhole(T_sensor_world_), view.bands_.data(), points_world, tolerance_m,
                 [&](std::size_t begin, std::size_t count, const std::int32_t* words) {
                   for (std::size_t i = 0; i < count; ++i)
                     counts[begin + i] =
                         static_cast<std::uint8_t>(counts[begin + i] + sign * (words[i] == kLookedThrough));
                 });
  };
  add(*this, 1);
  if (before != nullptr) add(*before, -1);
}

void SightView::look_at_all(const PointRun& points_world, const PointRun& normals_world, float tolerance_m,
                            std::int32_t* words) const {
  look_at(pinhole(T_sensor_world_), bands_.data(), points_world, normals_world, tolerance_m, words);
}

std::array<HalfSpace, 6> SightView::bounds(const Eigen::Isometry3f& T_sensor_points, float tolerance_m) const {
  // Past the farthest surface, and what a point may lie behind it (see `compare`), nothing is seen.
  const float end = (farthest_ + tolerance_m) / 0.99F;
  const std::array<Eigen::Vector4f, 6> sides{
      Eigen::Vector4f(0, 0, 1, -kNearest), Eigen::Vector4f(0, 0, -1, end),
      Eigen::Vector4f(fx_, 0, cx_, 0),     Eigen::Vector4f(-fx_, 0, width_f_ - cx_, 0),
      Eigen::Vector4f(0, fy_, cy_, 0),     Eigen::Vector4f(0, -fy_, height_f_ - cy_, 0)};
  std::array<HalfSpace, 6> spaces{};
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Eigen::Vector4f side = sides[i] / sides[i].head<3>().norm();
    const Eigen::Vector3f normal = T_sensor_points.linear().transpose() * side.head<3>();
    spaces[i] = {normal.x(), normal.y(), normal.z(),
                 side.head<3>().dot(T_sensor_points.translation()) + side.w()};
  }
  return spaces;
}

bool SightView::reaches(const Eigen::AlignedBox3f& box_world) const {
  if (empty()) return false;
  const float x = std::max(cx_, width_f_ - cx_) / fx_, y = std::max(cy_, height_f_ - cy_) / fy_;
  const float reach_m = farthest_ * std::sqrt(1 + x * x + y * y);  // into a corner of the view
  const Eigen::Vector3f eye_world = T_sensor_world_.inverse().translation();
  return box_world.squaredExteriorDistance(eye_world) <= reach_m * reach_m;
}

bool SightView::same_sensor(const SightView& other) const {
  return T_sensor_world_.matrix() == other.T_sensor_world_.matrix() && width_ == other.width_ &&
         height_ == other.height_ && fx_ == other.fx_ && fy_ == other.fy_ && cx_ == other.cx_ &&
         cy_ == other.cy_;
}

void SightView::widen() {
  const std::vector<Band> before = bands_;
  const auto merge = [](Band& band, const Band& other) {
    if (other.far == 0 || band.far == 0) return;
    band.near = std::min(band.near, other.near);
    band.far = std::max(band.far, other.far);
    band.edge = band.near;
  };
  for (int v = 0; v < height_; ++v)
    for (int u = 0; u < width_; ++u) {
      const auto at = [&](int x, int y) -> std::size_t {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
      };
      Band& band = bands_[at(u, v)];
      if (u > 0) merge(band, before[at(u - 1, v)]);
      if (u + 1 < width_) merge(band, before[at(u + 1, v)]);
      if (v > 0) merge(band, before[at(u, v - 1)]);
      if (v + 1 < height_) merge(band, before[at(u, v + 1)]);
    }
}

}  // namespace liloc
