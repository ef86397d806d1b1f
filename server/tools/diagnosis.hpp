#pragma once
// What `liloc doctor` makes of what it sees; pure.
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "common/credentials/credentials.hpp"
#include "common/geometry/camera.hpp"
#include "common/wire/dds/participant.hpp"
#include "common/wire/spots/status.hpp"

namespace liloc::toolbox {

enum class Verdict { good, doubtful, bad };

struct Finding {
  Verdict verdict = Verdict::good;
  std::string what;
  std::string remedy = {};  ///< empty where it is good
};

/// A kernel setting that should be at least `wanted`; `value` is empty where it cannot be read.
[[nodiscard]] Finding check_setting(const std::string& name, std::optional<long> value, long wanted);

/// A file that was given and cannot be used; the error names it.
[[nodiscard]] Finding unreadable_file(const Error& error);
[[nodiscard]] Finding unusable_network(const Error& error);

/// What `read_credentials` gave, looked at at `now`.
[[nodiscard]] std::vector<Finding> check_credentials(const Result<Credentials>& credentials,
                                                     std::chrono::system_clock::time_point now);

/// What was heard of servers.
struct Heard {
  std::vector<wire::ServerStatus> servers;  ///< the newest status of each
  std::vector<std::string> unreadable;      ///< what was wrong with others, each once
};
/// `seat` is where was listened; `site` what the servers should serve, where that is known.
[[nodiscard]] std::vector<Finding> check_servers(const Heard& heard, const wire::DomainOptions& seat,
                                                 const std::optional<Site>& site);

/// "ok    what", "warn  what; remedy", "FAIL  what; remedy", on one line without control characters.
[[nodiscard]] std::string line_of(const Finding& finding);

}  // namespace liloc::toolbox
