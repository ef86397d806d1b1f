#pragma once
// `liloc load`: simulated devices against a real server, in real time.
#include <functional>

#include "proto-tests/load/options.hpp"
#include "proto-tests/load/report.hpp"
#include "proto-tests/load/script.hpp"

namespace liloc::load {

/// One run with so many clients; processes of this run end before it returns. Errors: the server ended, DDS, a
/// stop signal. This process itself must not have joined any DDS domain.
[[nodiscard]] Result<LoadReport> run_load(const Script& script, const LoadOptions& options, int clients,
                                          const std::function<void(double)>& progress);

/// Writes OUT/load.json and OUT/load.svg.
[[nodiscard]] Status write_reports(const LoadOptions& options, const std::vector<LoadReport>& reports);

}  // namespace liloc::load
