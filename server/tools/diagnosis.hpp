#pragma once
// What `liloc doctor` makes of what it sees; pure.
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/camera.hpp"
#include "common/wire/status.hpp"

namespace liloc::toolbox {

enum class Verdict { good, doubtful, bad };

struct Finding {
  Verdict verdict = Verdict::good;
  std::string what;
  std::string remedy = {};  ///< empty where it is good
};

/// A kernel setting that should be at least `wanted`; `value` is empty where it cannot be read.
[[nodiscard]] Finding check_setting(const std::string& name, std::optional<long> value, long wanted);

/// The newest status of each server that was heard; `site` is what they should serve, where that is known.
[[nodiscard]] std::vector<Finding> check_servers(const std::vector<wire::ServerStatus>& servers,
                                                 const std::optional<Site>& site);

/// "ok    what", "warn  what; remedy", "FAIL  what; remedy".
[[nodiscard]] std::string line_of(const Finding& finding);

}  // namespace liloc::toolbox
