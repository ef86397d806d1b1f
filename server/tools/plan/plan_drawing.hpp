#pragma once
#include <string>

#include "server/tools/plan/plan_report.hpp"

namespace liloc::toolbox {

/// From above: of each piece of floor and furniture how much the LiDARs see, and where they hang.
[[nodiscard]] std::string coverage_svg(const PlanInput& input, const PlanFindings& findings);

/// From above: at each standing place eight sectors, the likelier a request is verified the greener; blind
/// places ringed, places that look alike joined.
[[nodiscard]] std::string localizability_svg(const PlanInput& input, const PlanFindings& findings);

}  // namespace liloc::toolbox
