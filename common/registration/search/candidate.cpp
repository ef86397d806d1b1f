#include "common/registration/search/candidate.hpp"

#include <algorithm>

namespace liloc {

bool same_place(const Pose& a, const Pose& b, const PlaceGate& gate) {
  return distance_m(a, b) < gate.distance_m && angle_between_rad(a, b) < gate.angle_rad;
}

std::vector<Candidate> distinct(std::vector<Candidate> candidates, std::size_t most) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  std::vector<Candidate> kept;
  for (const Candidate& c : candidates) {
    if (kept.size() >= most) break;
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Candidate& k) {
      return same_place(k.T_map_sensor, c.T_map_sensor);
    });
    if (!known) kept.push_back(c);
  }
  return kept;
}

}  // namespace liloc
