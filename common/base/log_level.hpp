#pragma once
#include "common/base/log.hpp"

namespace liloc::log {

/// As `level_from` reads it.
[[nodiscard]] const char* name_of(Level level);

}  // namespace liloc::log
