#pragma once
#include <string>
#include <string_view>

#include "common/base/result.hpp"

namespace liloc {

/// Ids name clients and LiDARs; they become topic names, partitions and folders, so they are 1 to 63 of
/// [A-Za-z0-9_-]. `what` names the field in the error.
[[nodiscard]] Result<std::string> valid_id(std::string_view id, std::string_view what);

}  // namespace liloc
