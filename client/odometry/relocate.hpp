#pragma once
#include <vector>

#include "common/registration/scan/scan_match.hpp"

namespace liloc {

/// Finds the sensor in the local map without a guess, as the paper's local registration does (section 5.1.1):
/// FPFH, RANSAC, then a scan match of each proposal. About 100 ms for a room. The matches that converged, best
/// overlap first; whether one is right the caller judges.
[[nodiscard]] std::vector<ScanMatch> relocate(const LocalMap& map, const std::vector<Surfel>& frame,
                                              StampNs now_ns, std::uint64_t seed);

/// Scan matches for a prior too wide to start from its mean: quick ones of few surfels start from a grid of
/// turns about the sensor's vertical and of steps across it, as wide as the prior, at most 0.8 rad and 0.6 m;
/// the best are matched in full. It stays the prior of all. The best first, by overlap less what the guess says
/// against it; whether one is right the caller judges. 5 to 20 times the cost of a match.
[[nodiscard]] std::vector<ScanMatch> match_widely(const LocalMap& map, const std::vector<Surfel>& frame,
                                                  const MotionGuess& guess, StampNs now_ns);

}  // namespace liloc
