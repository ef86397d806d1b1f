#pragma once
#include <vector>

#include "common/registration/scan_match.hpp"

namespace liloc {

/// Finds the sensor in the local map without a guess, as the paper's local registration does (section 5.1.1):
/// FPFH, RANSAC, then a scan match of each proposal. About 100 ms for a room. The matches that converged, best
/// overlap first; whether one is right the caller judges.
[[nodiscard]] std::vector<ScanMatch> relocate(const LocalMap& map, const std::vector<Surfel>& frame,
                                              StampNs now_ns, std::uint64_t seed);

/// A scan match from the guess and from guesses turned about the sensor's vertical by up to 23 degrees to
/// either side, for a guess too vague to start from: the one of best overlap. About five times the cost of a
/// match. Errors: those of `match_scan`.
[[nodiscard]] Result<ScanMatch> match_turned(const LocalMap& map, const std::vector<Surfel>& frame,
                                             const MotionGuess& guess, StampNs now_ns);

}  // namespace liloc
