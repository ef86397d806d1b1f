#pragma once
// Which of a search's poses comes first.
#include "common/registration/spot/judge.hpp"

namespace liloc {

/// Weights of a conditional logit: of the poses that one search proposed, which is the right one.
struct Ranking {
  double log_bits, log_conflict, agreement;
  double few_conflicts;  ///< below so much of conflict poses are told apart no better
};
// Of greatest likelihood over cold spots of two simulated kinds of sensors, DECISIONS.md.
/// Of poses that a proposer left, moved nearer with few points, judged with a wide tolerance.
inline constexpr Ranking kSketchRanking{2.8, 3.3, 4.2, 0.005};
/// Of refined poses.
inline constexpr Ranking kRefinedRanking{4.3, 2.1, 2.8, 0.0007};

/// Logarithm of a pose's odds but for a constant that all of a search share. What it recognizes counts by the
/// logarithm of how rare it is (`SurfaceBits`): agreement alone grows with the floor in view, whatever the
/// place. What contradicts counts by its logarithm too: the truth shows next to none.
[[nodiscard]] double standing_of(const Judgement& judgement, double bits, const Ranking& ranking);

}  // namespace liloc
