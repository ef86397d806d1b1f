#pragma once
// What decisions rested on, against the truth: rows on which other thresholds can be tried without a search.
#include <string>
#include <vector>

#include "server/localization/verification.hpp"

namespace liloc::bench {

struct EvidenceRow {
  std::uint64_t seed = 0;
  bool live = false;  ///< of a session as a server keeps it; otherwise of one that never believes what it finds
  double overlap = 0;                          ///< true
  bool own_right = false, best_right = false;  ///< within 10 deg and 0.3 m
  Evidence evidence;                           ///< of the estimates only the standard deviations survive a file

  [[nodiscard]] bool followed() const { return !evidence.own; }
};

[[nodiscard]] EvidenceRow against_truth(const Evidence& evidence, const Pose& T_map_sensor_true);

/// Errors: the file cannot be written or read; a row that is none, by its line.
[[nodiscard]] Status write_evidence(const std::string& path, const std::vector<EvidenceRow>& rows);
[[nodiscard]] Result<std::vector<EvidenceRow>> read_evidence(const std::string& path);

}  // namespace liloc::bench
