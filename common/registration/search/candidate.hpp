#pragma once
#include <vector>

#include "common/geometry/pose.hpp"

namespace liloc {

/// How far two poses may differ and still be called the same place.
/// Defaults are by hand where nothing else is said.
struct PlaceGate {
  double distance_m = 0.25;
  double angle_rad = radians(8.0);
};
[[nodiscard]] bool same_place(const Pose& a, const Pose& b, const PlaceGate& gate = {});

struct Candidate {
  Pose T_map_sensor = Pose::Identity();
  double score = 0;  ///< the proposer's own; only `judge` compares proposers
};

/// Sorts by score and keeps the best candidate of each place.
[[nodiscard]] std::vector<Candidate> distinct(std::vector<Candidate> candidates, std::size_t most);

}  // namespace liloc
