#pragma once
// One spot: propose by whatever is known, judge all candidates alike, refine the best few.
#include <vector>

#include "common/registration/spot/hypothesis.hpp"
#include "common/registration/spot/proposers.hpp"

namespace liloc {

/// Judges candidates roughly, refines the best, judges them again. Distinct hypotheses: first the one that
/// stands highest (`standing_of`), then by the judge's score.
[[nodiscard]] std::vector<Hypothesis> judge_candidates(const SpotProblem& problem,
                                                       std::vector<Candidate> candidates);

}  // namespace liloc
