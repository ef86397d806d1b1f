#include "common/recording/site_extent.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "common/base/quantile.hpp"
#include "common/geometry/regions.hpp"

namespace liloc {
namespace {

constexpr double kReach_m = 10;  // of a LiDAR, sideways
// A box of these walls takes some gigabyte; over twice what 64 LiDARs, as many as a status holds, can cover.
constexpr double kLargest_m2 = 10'000;
constexpr double kFarthest_m = 1000;      // no site is wider than 2 km
constexpr double kFromOrigin_m = 16'000;  // floats of the map are 1 mm apart there
constexpr double kHighest_m = 100;        // above each other: a high building

struct Outlier {
  std::size_t index = 0;
  double away_m = 0;  ///< from the middle one
};

/// The one that hangs farthest from the middle of those in the region; of two the second.
Outlier farthest_in(const Region& region, const std::vector<GlobalLidar>& lidars) {
  const auto place = [&](std::size_t i) -> Eigen::Vector2d {
    return lidars[i].T_map_sensor.translation().head<2>();
  };
  std::vector<std::size_t> members;
  std::array<std::vector<double>, 2> along;
  for (std::size_t i = 0; i < lidars.size(); ++i) {
    if (!region.contains(place(i))) continue;
    members.push_back(i);
    along[0].push_back(place(i).x());
    along[1].push_back(place(i).y());
  }
  const Eigen::Vector2d middle(quantile(along[0], 0.49), quantile(along[1], 0.49));
  const auto away = [&](std::size_t i) { return (place(i) - middle).norm(); };
  const std::size_t far = *std::ranges::max_element(members, {}, away);
  return {far, away(far)};
}

tl::unexpected<Error> refused(const std::string& file, std::size_t index, const std::string& why) {
  return fail("{}: global_lidars[{}].T_map_sensor.translation: {}: give metres, or make two sites", file, index,
              why);
}

Status check_rise(const std::string& file, const std::vector<GlobalLidar>& lidars) {
  const auto height_m = [](const GlobalLidar& lidar) { return lidar.T_map_sensor.translation().z(); };
  const auto [lowest, highest] = std::ranges::minmax_element(lidars, {}, height_m);
  const double rise_m = height_m(*highest) - height_m(*lowest);
  if (rise_m <= kHighest_m) return {};
  std::vector<double> heights;
  std::ranges::transform(lidars, std::back_inserter(heights), height_m);
  const double middle_m = quantile(std::move(heights), 0.49);
  const bool too_high = height_m(*highest) - middle_m >= middle_m - height_m(*lowest);
  const auto off = too_high ? highest : lowest, other = too_high ? lowest : highest;
  return refused(file, static_cast<std::size_t>(off - lidars.begin()),
                 fmt::format("{} hangs {:.0f} m {} {}, must be at most {:.0f} m", off->id, rise_m,
                             too_high ? "above" : "below", other->id, kHighest_m));
}

/// The map is kept in floats.
Status check_origin(const std::string& file, const std::vector<GlobalLidar>& lidars) {
  for (std::size_t i = 0; i < lidars.size(); ++i) {
    const double away_m = lidars[i].T_map_sensor.translation().cwiseAbs().maxCoeff();
    if (away_m > kFromOrigin_m)
      return fail(
          "{}: global_lidars[{}].T_map_sensor.translation: {} hangs {:.0f} m from the map's origin, must be at "
          "most {:.0f} m: give metres, or subtract a common offset",
          file, i, lidars[i].id, away_m, kFromOrigin_m);
  }
  return {};
}

/// Rooms that lie far apart have grids of their own.
Status check_rooms(const std::string& file, const std::vector<GlobalLidar>& lidars) {
  std::vector<Region> seen;
  for (const GlobalLidar& lidar : lidars) {
    const Eigen::Vector2d place = lidar.T_map_sensor.translation().head<2>();
    seen.emplace_back(place.array() - kReach_m, place.array() + kReach_m);
  }
  for (const Region& room : merged(seen, kFarApart_m)) {
    if (room.volume() <= kLargest_m2) continue;
    const Outlier far = farthest_in(room, lidars);
    return refused(
        file, far.index,
        fmt::format("{} hangs {:.0f} m from the middle one; rooms that hang together span at most {:.0f} m2 "
                    "along the map's axes, with {:.0f} m around, these {:.0f} x {:.0f} m",
                    lidars[far.index].id, far.away_m, kLargest_m2, kReach_m, room.sizes().x(),
                    room.sizes().y()));
  }
  return {};
}

}  // namespace

Status check_extent(const std::string& file, const std::vector<GlobalLidar>& lidars) {
  if (lidars.empty()) return {};
  const Outlier far = farthest_in(everywhere(), lidars);
  if (far.away_m > kFarthest_m)
    return refused(file, far.index,
                   fmt::format("{} hangs {:.0f} m from the middle one, must be at most {:.0f} m",
                               lidars[far.index].id, far.away_m, kFarthest_m));
  if (const Status rise = check_rise(file, lidars); !rise) return rise;
  if (const Status origin = check_origin(file, lidars); !origin) return origin;
  return check_rooms(file, lidars);
}

}  // namespace liloc
