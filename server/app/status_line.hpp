#pragma once
#include <string>
#include <vector>

#include "common/wire/spots/status.hpp"
#include "server/global_cloud/depth_noise.hpp"

namespace liloc {

/// A status as one line of the log. `noise`: of the LiDARs, in the same order; what is not known is left out.
[[nodiscard]] std::string status_line(const wire::ServerStatus& status, const std::vector<DepthNoise>& noise);

}  // namespace liloc
