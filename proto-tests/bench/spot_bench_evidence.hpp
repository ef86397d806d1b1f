#pragma once
// What searches rested on, against the truth: from these rows fit_confidence.py makes the model of confidence.
#include <string>
#include <vector>

#include "server/localization/verification.hpp"

namespace liloc::bench {

struct EvidenceRow {
  std::string site, client;
  std::uint64_t seed = 0;
  bool cold = false;        ///< one spot on its own; otherwise of a session that never believes what it finds
  double t_s = 0;           ///< since the client's first request
  double overlap = 0;       ///< true
  std::vector<bool> right;  ///< of each place: within 10 deg and 0.3 m
  Evidence evidence;
};

[[nodiscard]] std::vector<bool> against_truth(const Evidence& evidence, const Pose& T_map_sensor_true);

/// One line per place, best first. Error: the file cannot be written.
[[nodiscard]] Status write_evidence(const std::string& path, const std::vector<EvidenceRow>& rows);

}  // namespace liloc::bench
