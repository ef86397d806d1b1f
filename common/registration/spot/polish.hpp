#pragma once
#include "common/registration/spot/hypothesis.hpp"

namespace liloc {

/// How a pose climbs towards less contradiction.
/// Defaults are by hand where nothing else is said.
struct PolishOptions {
  double shift_m = 0.2, turn_rad = radians(4.0);  ///< first step of each axis; halved `halvings` times
  int halvings = 3, rounds = 4;
  double hold = 0.003;    ///< RefineOptions::hold of what follows; 0.01 was too stiff (DECISIONS.md)
  double as_good = 0.02;  ///< in points of score; so much the freer refinement may lose and is still preferred
  double clean = 0.998;   ///< overlap and map agreement from which a hypothesis needs no climb ...
  double clean_agree = 0.3;  ///< ... if so many device points agree
};

/// Whether next to nothing contradicts the hypothesis.
[[nodiscard]] bool is_clean(const Hypothesis& hypothesis, const PolishOptions& options = {});

/// Refines and judges a pose whose surfaces may not hold it, a bare floor with people on it say: there pairs
/// of points slide, while lines of sight still tell where it cannot be. Climbs the judge's score in six axes
/// from the guess, then refines held near that, and then free; of these and of `refined`, the free refinement
/// of the same guess, the best by score. Pure.
[[nodiscard]] Hypothesis polish(const SpotProblem& problem, const Pose& T_map_sensor_guess, Hypothesis refined,
                                const PolishOptions& options = {});

}  // namespace liloc
