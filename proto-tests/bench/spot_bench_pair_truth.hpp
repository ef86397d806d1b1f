#pragma once
// Published pairs of fragments, and what of a pair truly overlaps.
#include <map>
#include <string>
#include <vector>

#include "common/geometry/cloud.hpp"
#include "common/geometry/pose.hpp"

namespace liloc::bench {

struct Pair {
  int target = 0, source = 0;
  Pose T_target_source = Pose::Identity();
};
/// Of a log of lines `i j n`, each with the 4x4 that maps fragment j into i. Error: no such file or no pair.
[[nodiscard]] Result<std::vector<Pair>> read_pairs(const std::string& path);

struct Fragment {
  Cloud raw, thin;  ///< thin: one point per 0.05 m, with normals
};
/// FOLDER/cloud_bin_I.ply, each read once.
class Fragments {
 public:
  explicit Fragments(std::string folder) : folder_(std::move(folder)) {}
  [[nodiscard]] Result<const Fragment*> at(int index);

 private:
  std::string folder_;
  std::map<int, Fragment> read_;
};

/// The source's points that have a neighbour within 0.05 m in the target, at the truth.
[[nodiscard]] Cloud overlapping(const Cloud& source, const Cloud& target, const Pose& T_target_source);

/// By how much two poses of some points differ; 9 without points.
[[nodiscard]] double rmse_m(const Cloud& points, const Pose& a, const Pose& b);

}  // namespace liloc::bench
