#pragma once
#include <optional>
#include <string>
#include <vector>

#include "proto-tests/load/report.hpp"

namespace liloc::load {

/// The first count of clients at which p99 is over an interval or availability under 0.99; empty: none.
[[nodiscard]] std::optional<int> knee_of(const std::vector<LoadReport>& reports, double interval_ms);
/// Latency over clients, both logarithmic, with the knee, as SVG. At least one report, by rising clients.
[[nodiscard]] std::string plot_svg(const std::vector<LoadReport>& reports, double interval_ms);

}  // namespace liloc::load
