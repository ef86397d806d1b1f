#include "server/app/json_line.hpp"

#include <fmt/chrono.h>

#include <nlohmann/json.hpp>

#include "common/base/log_level.hpp"

namespace liloc {

std::string json_line(std::chrono::system_clock::time_point at, log::Level level, std::string_view message) {
  const auto whole = std::chrono::floor<std::chrono::seconds>(at);
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(at - whole).count();
  const std::time_t seconds = std::chrono::system_clock::to_time_t(whole);
  nlohmann::ordered_json line;
  line["time"] = fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(seconds), ms);
  line["level"] = log::name_of(level);
  line["message"] = message;
  return line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace liloc
