#include "common/registration/scan/local_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "common/geometry/voxel.hpp"

namespace liloc {
namespace {

constexpr std::uint64_t kFree = ~std::uint64_t{0};
constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr std::size_t kFirstSlots = 1 << 15;  // grows when half full
constexpr float kSameSide = 0.7F;             // cosine of 45 degrees

/// The nearest return around a pixel, so that the rim of an object does not count as a view past it; 0 = none.
std::uint16_t nearest_around(const DepthImage& image, int u, int v) {
  std::uint16_t nearest = 0;
  for (int dv = -1; dv <= 1; ++dv)
    for (int du = -1; du <= 1; ++du) {
      const std::uint16_t d = image.at(u + du, v + dv);
      if (d == 0) return 0;
      nearest = nearest == 0 ? d : std::min(nearest, d);
    }
  return nearest;
}

enum class Sight { outside, agree, through, hidden };

/// Compares points of the map with a depth image.
class Projector {
 public:
  Projector(const Pose& T_map_sensor, const DepthImage& image, const Camera& camera, double max_range_m)
      : T_sensor_map_(T_map_sensor.inverse().cast<float>()),
        image_(image),
        fx_(static_cast<float>(camera.fx)),
        fy_(static_cast<float>(camera.fy)),
        cx_(static_cast<float>(camera.cx)),
        cy_(static_cast<float>(camera.cy)),
        scale_(static_cast<float>(camera.depth_scale_m)),
        farthest_(static_cast<float>(max_range_m)) {}

  Sight operator()(const Eigen::Vector3f& point_map) const {
    const Eigen::Vector3f p = T_sensor_map_ * point_map;
    if (p.z() < 0.3F || p.z() > farthest_) return Sight::outside;
    const int u = static_cast<int>(std::lround(p.x() / p.z() * fx_ + cx_));
    const int v = static_cast<int>(std::lround(p.y() / p.z() * fy_ + cy_));
    if (u < 1 || v < 1 || u + 1 >= image_.width || v + 1 >= image_.height) return Sight::outside;
    const float seen = static_cast<float>(nearest_around(image_, u, v)) * scale_;
    if (seen == 0) return Sight::outside;
    const float tolerance = std::max(0.15F, 0.05F * p.z());
    if (seen > p.z() + tolerance) return Sight::through;
    return seen < p.z() - tolerance ? Sight::hidden : Sight::agree;
  }

 private:
  Eigen::Isometry3f T_sensor_map_;
  const DepthImage& image_;
  float fx_, fy_, cx_, cy_, scale_, farthest_;
};

}  // namespace

LocalMap::LocalMap(const LocalMapOptions& options)
    : options_(options), inverse_(static_cast<float>(1.0 / options.cell_m)) {
  rebuild(kFirstSlots);
}

std::uint32_t LocalMap::lookup(std::uint64_t key) const {
  std::size_t slot = (key * 0x9E3779B97F4A7C15ULL) >> shift_;
  while (keys_[slot] != kFree) {
    if (keys_[slot] == key) return slots_[slot];
    slot = (slot + 1) & (keys_.size() - 1);
  }
  return kNone;
}

void LocalMap::rebuild(std::size_t slots) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i].surfel.count == 0) continue;
    cells_[kept] = cells_[i];
    cell_keys_[kept++] = cell_keys_[i];
  }
  cells_.resize(kept);
  cell_keys_.resize(kept);
  keys_.assign(slots, kFree);
  slots_.assign(slots, kNone);
  shift_ = 64 - std::countr_zero(slots);
  for (std::size_t i = 0; i < kept; ++i) {
    std::size_t slot = (cell_keys_[i] * 0x9E3779B97F4A7C15ULL) >> shift_;
    while (keys_[slot] != kFree) slot = (slot + 1) & (slots - 1);
    keys_[slot] = cell_keys_[i];
    slots_[slot] = static_cast<std::uint32_t>(i);
  }
}

void LocalMap::add(std::uint64_t key, const Surfel& surfel, StampNs stamp_ns) {
  if ((cells_.size() + 1) * 2 > keys_.size())
    rebuild(alive_ * 3 > keys_.size() ? keys_.size() * 2 : keys_.size());
  std::size_t slot = (key * 0x9E3779B97F4A7C15ULL) >> shift_;
  while (keys_[slot] != kFree) slot = (slot + 1) & (keys_.size() - 1);
  keys_[slot] = key;
  slots_[slot] = static_cast<std::uint32_t>(cells_.size());
  cells_.push_back({surfel, stamp_ns, stamp_ns, 1, 0});
  cell_keys_.push_back(key);
  ++alive_;
}

void LocalMap::merge(Cell& cell, const Surfel& surfel, const Eigen::Vector3f& sensor, StampNs stamp_ns) {
  Surfel& s = cell.surfel;
  if (s.count == 0) {  // removed before, seen anew
    cell = {surfel, stamp_ns, stamp_ns, 1, 0};
    ++alive_;
    return;
  }
  cell.last_ns = stamp_ns;
  ++cell.views;
  if (s.count >= options_.full_weight || s.normal.dot(surfel.normal) < 0) return;
  const float total = s.count + surfel.count, share = surfel.count / total;
  const Eigen::Vector3f offset = surfel.mean - s.mean;
  s.covariance = (1 - share) * s.covariance + share * surfel.covariance +
                 share * (1 - share) * offset * offset.transpose();
  s.mean += share * offset;
  s.count = total;
  orient(s, sensor);
}

void LocalMap::insert(const Pose& T_map_sensor, const std::vector<Surfel>& frame, StampNs stamp_ns) {
  const Eigen::Isometry3f T = T_map_sensor.cast<float>();
  const Eigen::Vector3f sensor = T.translation();
  for (const Surfel& seen : frame) {
    Surfel moved = seen;
    moved.mean = T * seen.mean;
    moved.normal = T.linear() * seen.normal;
    moved.covariance = T.linear() * seen.covariance * T.linear().transpose();
    const std::uint64_t key = cell_key(cell_of(moved.mean, inverse_));
    const std::uint32_t index = lookup(key);
    if (index == kNone)
      add(key, moved, stamp_ns);
    else
      merge(cells_[index], moved, sensor, stamp_ns);
  }
  if (alive_ > options_.max_surfels) trim(stamp_ns);
}

void LocalMap::trim(StampNs stamp_ns) {
  std::vector<StampNs> ages;
  ages.reserve(alive_);
  for (const Cell& cell : cells_)
    if (cell.surfel.count > 0) ages.push_back(stamp_ns - cell.last_ns);
  const auto keep = static_cast<std::ptrdiff_t>(options_.max_surfels * 9 / 10);
  std::nth_element(ages.begin(), ages.begin() + keep, ages.end());
  const StampNs oldest = ages[static_cast<std::size_t>(keep)];
  for (Cell& cell : cells_)
    if (cell.surfel.count > 0 && stamp_ns - cell.last_ns >= oldest && cell.last_ns != stamp_ns) {
      cell.surfel.count = 0;
      --alive_;
    }
  rebuild(keys_.size());
}

void LocalMap::carve(const Pose& T_map_sensor, const DepthImage& image, const Camera& camera,
                     double max_range_m) {
  const Projector project(T_map_sensor, image, camera, max_range_m);
  for (Cell& cell : cells_) {
    if (cell.surfel.count == 0) continue;
    const Sight sight = project(cell.surfel.mean);
    if (sight == Sight::agree) cell.refuted = 0;
    if (sight != Sight::through || ++cell.refuted < options_.refuted_after) continue;
    cell.surfel.count = 0;
    --alive_;
  }
}

LocalMap::View LocalMap::compare(const Pose& T_map_sensor, const DepthImage& image, const Camera& camera,
                                 double max_range_m) const {
  const Projector project(T_map_sensor, image, camera, max_range_m);
  View view;
  for (const Cell& cell : cells_) {
    if (cell.surfel.count == 0) continue;
    const Sight sight = project(cell.surfel.mean);
    view.agree += sight == Sight::agree;
    view.through += sight == Sight::through;
    view.hidden += sight == Sight::hidden;
  }
  return view;
}

const LocalMap::Cell* LocalMap::find(const Eigen::Vector3f& p, const Eigen::Vector3f& normal, int reach) const {
  const Eigen::Vector3i base = cell_of(p - Eigen::Vector3f::Constant(0.5F / inverse_), inverse_);
  const Cell* best = nullptr;
  const float farthest = (static_cast<float>(reach) + 0.5F) / inverse_;
  float nearest = farthest * farthest;
  for (int z = 1 - reach; z <= reach; ++z)
    for (int y = 1 - reach; y <= reach; ++y)
      for (int x = 1 - reach; x <= reach; ++x) {
        const std::uint32_t index = lookup(cell_key(base + Eigen::Vector3i(x, y, z)));
        if (index == kNone) continue;
        const Cell& cell = cells_[index];
        if (cell.surfel.count == 0) continue;
        const float squared = (cell.surfel.mean - p).squaredNorm();
        if (squared < nearest && cell.surfel.normal.dot(normal) > kSameSide) {
          nearest = squared;
          best = &cell;
        }
      }
  return best;
}

float LocalMap::trust(const Cell& cell, StampNs now_ns) const {
  const bool young = cell.views < 3 || now_ns - cell.first_ns < options_.trust_after_ns;
  return young ? kYoungWeight : 1.0F;
}

Cloud LocalMap::cloud() const {
  Cloud cloud;
  cloud.points.reserve(alive_);
  cloud.normals.reserve(alive_);
  for (const Cell& cell : cells_) {
    if (cell.surfel.count == 0) continue;
    cloud.points.push_back(cell.surfel.mean);
    cloud.normals.push_back(cell.surfel.normal);
  }
  return cloud;
}

Cloud LocalMap::standing(StampNs since_ns, StampNs now_ns) const {
  Cloud cloud;
  for (const Cell& cell : cells_) {
    if (cell.surfel.count == 0 || cell.last_ns < since_ns || trust(cell, now_ns) < 1) continue;
    cloud.points.push_back(cell.surfel.mean);
    cloud.normals.push_back(cell.surfel.normal);
  }
  return cloud;
}

}  // namespace liloc
