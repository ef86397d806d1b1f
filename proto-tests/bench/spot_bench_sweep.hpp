#pragma once
#include "proto-tests/bench/spot_bench_evidence.hpp"

namespace liloc::bench {

/// Prints, as Markdown, how often other thresholds would have verified a wrong pose and refused a right one.
void print_sweep(const std::vector<EvidenceRow>& rows);

}  // namespace liloc::bench
