#pragma once
#include <map>
#include <optional>
#include <string>

#include "common/geometry/pose.hpp"

namespace liloc::bags {

/// The tree of coordinate frames of a bag; of each frame its newest transform. Bounded; not thread-safe.
class Frames {
 public:
  static constexpr std::size_t kMost = 10'000;  // by hand
  void add(const std::string& parent, const std::string& child, const Pose& T_parent_child);
  /// Empty where no chain of transforms ties the two, or the tree runs in a circle.
  [[nodiscard]] std::optional<Pose> T_to_from(const std::string& to, const std::string& from) const;

 private:
  struct Link {
    std::string parent;
    Pose T_parent_child;
  };
  std::map<std::string, Link> links_;  ///< by child
};

}  // namespace liloc::bags
