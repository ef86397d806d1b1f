#pragma once
// All that the page shows besides points, as JSON; `part` names which message it is. Lengths are metres unless
// the name says otherwise; poses are [x, y, z, qx, qy, qz, qw] in the map frame. page/src/messages.js reads it.
#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "common/geometry/camera.hpp"
#include "common/geometry/depth.hpp"
#include "server/view/journal.hpp"
#include "server/view/log_tail.hpp"
#include "server/web/facts.hpp"

namespace liloc::view {

using Devices = std::vector<std::shared_ptr<const DeviceState>>;

/// Where each LiDAR hangs, and the tangents of its view's edges [left, right, top, bottom].
[[nodiscard]] std::string site_message(const Site& site, const web::ServerFacts& facts);

/// Health and load, LiDARs in the site's order, and each device's last answer. `axes` are the axes of a
/// device's position uncertainty in the map frame, each as long as one standard deviation.
[[nodiscard]] std::string now_message(const web::ServerFacts& facts, const Devices& devices,
                                      std::chrono::steady_clock::time_point now);

/// By device: x, y, z in centimetres of each place, the oldest first.
[[nodiscard]] std::string trails_message(const Devices& devices);

[[nodiscard]] std::string charts_message(const std::vector<ChartColumn>& columns);

/// Each line as [UTC in ms, level, text].
[[nodiscard]] std::string log_message(const std::vector<LogLine>& lines);

}  // namespace liloc::view
