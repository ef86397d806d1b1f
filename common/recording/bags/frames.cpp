#include "common/recording/bags/frames.hpp"

#include <vector>

namespace liloc::bags {
namespace {

/// ROS 1 began names with a slash, and some bags still do.
std::string plain(const std::string& frame) {
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

}  // namespace

void Frames::add(const std::string& parent, const std::string& child, const Pose& T_parent_child) {
  if (links_.size() < kMost || links_.contains(plain(child)))
    links_.insert_or_assign(plain(child), Link{plain(parent), T_parent_child});
}

std::optional<Pose> Frames::T_to_from(const std::string& to, const std::string& from) const {
  struct Ancestor {
    std::string frame;
    Pose T_frame_start;
  };
  const auto chain = [&](const std::string& start) {
    std::vector<Ancestor> all{{plain(start), Pose::Identity()}};
    for (auto link = links_.find(all.back().frame); link != links_.end() && all.size() < 100;
         link = links_.find(all.back().frame))
      all.push_back({link->second.parent, link->second.T_parent_child * all.back().T_frame_start});
    return all;
  };
  const auto of_to = chain(to);
  for (const Ancestor& a : chain(from))
    for (const Ancestor& b : of_to)
      if (a.frame == b.frame) return b.T_frame_start.inverse() * a.T_frame_start;
  return std::nullopt;
}

}  // namespace liloc::bags
