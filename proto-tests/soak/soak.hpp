#pragma once
// `liloc soak`: a whole site for hours, in which everything comes and goes, and nothing may grow.
#include <functional>

#include "proto-tests/soak/report.hpp"
#include "proto-tests/soak/tape.hpp"

namespace liloc::soak {

/// Makes the folder, and takes away what a run before this one left: its verdict is none of this one's. Error:
/// the system's.
[[nodiscard]] Status clear_results(const std::filesystem::path& out);

/// Starts servers, clients and sensors as processes of their own, which end before it returns, and writes
/// soak.json, samples.csv and visits.csv. Errors: a process ended by itself, DDS, a stop signal; soak.json then
/// says so, and samples.csv has what came before. That something grew is in the report. This process itself
/// must not have joined any DDS domain.
[[nodiscard]] Result<SoakReport> run_soak(const Tape& tape, const SoakOptions& options,
                                          const std::function<void(double)>& progress);

}  // namespace liloc::soak
