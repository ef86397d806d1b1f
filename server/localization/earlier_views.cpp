#include "server/localization/earlier_views.hpp"

#include <algorithm>
#include <utility>

namespace liloc {
namespace {

// All by hand. Odometry ties views together for some seconds, and who stays for longer is furniture.
constexpr std::size_t kViews = 5;
constexpr StampNs kOldest_ns = from_seconds(6.0);
constexpr float kTolerance_m = 0.05F;  // looked through: twice that, and 2 % of the depth, before a surface
constexpr double kMostMoving = 0.3;    // of the points

}  // namespace

std::vector<std::uint32_t> EarlierViews::moving(const SpotRequest& request, const Cloud& cloud_sensor) const {
  std::vector<std::pair<const SightView*, Eigen::Isometry3f>> views;
  for (const Seen& seen : seen_)
    if (seen.segment == request.odom_segment && seen.stamp_ns < request.stamp_ns &&
        request.stamp_ns - seen.stamp_ns <= kOldest_ns)
      views.emplace_back(&seen.view, (seen.T_odom_sensor.inverse() * request.T_odom_sensor).cast<float>());
  std::vector<std::uint32_t> moving;
  for (std::size_t i = 0; i < cloud_sensor.size(); ++i)
    if (std::ranges::any_of(views, [&](const auto& view) {
          return view.first->look_sensor(view.second * cloud_sensor.points[i], kTolerance_m) == Sight::conflict;
        }))
      moving.push_back(static_cast<std::uint32_t>(i));
  if (static_cast<double>(moving.size()) > kMostMoving * static_cast<double>(cloud_sensor.size())) return {};
  return moving;
}

void EarlierViews::add(const SpotRequest& request, SightView view) {
  seen_.push_back({std::move(view), request.T_odom_sensor, request.stamp_ns, request.odom_segment});
  if (seen_.size() > kViews) seen_.pop_front();
}

}  // namespace liloc
