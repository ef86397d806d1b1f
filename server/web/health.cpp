#include "server/web/health.hpp"

#include <algorithm>

namespace liloc::web {
namespace {

constexpr double kHung_s = 5;         // five beats missed
constexpr double kHungWorker_s = 10;  // five times what a search may take (ServerOptions::localizer)
constexpr int kOk = 200, kUnavailable = 503;

}  // namespace

Page live_page(const ServerFacts& facts) {
  if (facts.network_idle_s >= kHung_s)
    return {kUnavailable, fmt::format("the network's thread has hung for {:.0f} s\n", facts.network_idle_s)};
  if (facts.service.longest_work_s >= kHungWorker_s)
    return {kUnavailable, fmt::format("a worker has hung for {:.0f} s\n", facts.service.longest_work_s)};
  return {kOk, "ok\n"};
}

Page ready_page(const ServerFacts& facts) {
  if (Page live = live_page(facts); live.status != kOk) return live;
  const auto heard = std::ranges::count_if(
      facts.lidars, [](const LidarFacts& lidar) { return wire::is_heard(lidar.health.state); });
  if (heard == 0)
    return {kUnavailable, fmt::format("none of {} ceiling LiDARs is heard\n", facts.lidars.size())};
  return {kOk, fmt::format("{} of {} ceiling LiDARs are heard\n", heard, facts.lidars.size())};
}

}  // namespace liloc::web
