#include "common/base/distinct_topics.hpp"

#include <map>

#include "common/base/ros_name.hpp"

namespace liloc {

Status check_distinct_topics(const std::vector<std::string>& ids) {
  std::map<std::string, std::string> taken;
  for (const std::string& id : ids) {
    const auto [other, fresh] = taken.emplace(ros_name(id), id);
    if (fresh) continue;
    if (other->second == id) return fail("{}: two sensors have this id; rename one", id);
    return fail("{} and {} are one in the names of topics, where a hyphen is an underscore; rename one",
                other->second, id);
  }
  return {};
}

}  // namespace liloc
