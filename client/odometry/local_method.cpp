#include "client/odometry/local_method.hpp"

namespace liloc {

Result<LocalMethod> local_method_from(std::string_view name) {
  if (name == "cloud") return LocalMethod::cloud;
  if (name == "inertial") return LocalMethod::inertial;
  if (name == "dead-reckoning") return LocalMethod::dead_reckoning;
  if (name == "external") return LocalMethod::external;
  return fail("local method is '{}'; must be cloud, inertial, dead-reckoning or external", name);
}

}  // namespace liloc
