#pragma once
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace liloc {

/// Of sensors whose topics meet on one network. Error: two have one id, or ids that are one in the names of
/// topics (ros_name).
[[nodiscard]] Status check_distinct_topics(const std::vector<std::string>& ids);

}  // namespace liloc
