#include "common/geometry/regions.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

namespace liloc {
namespace {

// Each with each is compared: a millisecond; 64 LiDARs, as many as a site has, light up half of it. By hand.
constexpr std::size_t kMostPlaces = 512;

bool near(const Region& a, const Region& b, double apart_m) {
  const Eigen::Array2d gap = a.min().array().max(b.min().array()) - a.max().array().min(b.max().array());
  return gap.maxCoeff() < apart_m;
}

/// Merges the first pair that is near; false: there is none.
bool merge_one(std::vector<Region>* boxes, double apart_m) {
  for (std::size_t i = 0; i < boxes->size(); ++i)
    for (std::size_t j = i + 1; j < boxes->size(); ++j)
      if (near((*boxes)[i], (*boxes)[j], apart_m)) {
        (*boxes)[i].extend((*boxes)[j]);
        (*boxes)[j] = boxes->back();
        boxes->pop_back();
        return true;
      }
  return false;
}

}  // namespace

std::vector<Region> merged(std::vector<Region> boxes, double apart_m) {
  std::erase_if(boxes, [](const Region& box) { return box.isEmpty(); });
  while (merge_one(&boxes, apart_m)) {
  }
  std::ranges::sort(boxes, {}, [](const Region& box) { return std::tuple(box.min().x(), box.min().y()); });
  return boxes;
}

std::vector<Region> regions_of(const std::vector<Eigen::Vector3f>& points, double apart_m) {
  Region all;
  std::map<std::pair<double, double>, Region> places;
  std::pair<double, double> last_at;
  Region* last = nullptr;  // points come mostly as neighbours
  for (const Eigen::Vector3f& p : points) {
    if (!p.allFinite()) continue;
    const Eigen::Vector2d place = p.head<2>().cast<double>();
    all.extend(place);
    const Eigen::Array2d cell = (place.array() / apart_m).floor();
    const std::pair at{cell.x(), cell.y()};
    if (last == nullptr || at != last_at) {
      last = &places[at];
      last_at = at;
      if (places.size() > kMostPlaces) break;
    }
    last->extend(place);
  }
  if (all.isEmpty()) return {};
  if (places.size() > kMostPlaces) {
    for (const Eigen::Vector3f& p : points)
      if (p.allFinite()) all.extend(p.head<2>().cast<double>().eval());
    return {all};
  }
  std::vector<Region> boxes;
  for (const auto& [at, box] : places) boxes.push_back(box);
  return merged(std::move(boxes), apart_m);
}

Region everywhere() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {Eigen::Vector2d::Constant(-kInfinity), Eigen::Vector2d::Constant(kInfinity)};
}

}  // namespace liloc
