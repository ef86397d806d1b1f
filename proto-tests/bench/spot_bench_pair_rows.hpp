#pragma once
#include <string>

#include "common/base/result.hpp"

namespace liloc::bench {

/// Aligns the pairs of FOLDER/gt.log and gt_low_overlap.log, and some that neither names, whose truth follows
/// by the chain of those that are named; appends to `file` a row for each pose that came into question: scene,
/// kind (0 gt.log, 1 low overlap, 2 other of at least 0.1, 3 of less), target, source, overlap, rank, RMSE to
/// the truth, regressors. For fit_align.py. Errors: as run_pairs.
[[nodiscard]] Status write_pair_rows(const std::string& folder, const std::string& file);

}  // namespace liloc::bench
