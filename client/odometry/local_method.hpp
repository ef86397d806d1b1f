#pragma once
#include <string_view>

#include "common/base/result.hpp"

namespace liloc {

/// How a device follows its own motion. external: somebody else keeps the odometry
/// (`Engine::add_odometry`); the engine registers nothing locally.
enum class LocalMethod { cloud, inertial, dead_reckoning, external };
/// By its name on a command line. Errors: no such method; the message names those there are.
[[nodiscard]] Result<LocalMethod> local_method_from(std::string_view name);

}  // namespace liloc
