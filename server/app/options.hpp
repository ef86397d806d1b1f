#pragma once
// What `liloc-server` is told on its command line or in a file.
#include <optional>
#include <string>

#include "common/base/log.hpp"
#include "common/wire/dds/participant.hpp"
#include "server/answers/store.hpp"
#include "server/localization/localizer.hpp"
#include "server/service/service_options.hpp"
#include "server/web/web_server.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct ServerOptions {
  std::string site_file;
  std::string state_file;  ///< what the server learns of the site; empty: kept in memory alone
  wire::DomainOptions seat;
  LocalizerOptions localizer{.search_limit = std::chrono::seconds(2)};
  ServiceOptions service;
  std::optional<answers::StoreOptions> save_answers;
  log::Level log_level = log::Level::info;
  bool log_json = false;                ///< a JSON object a line, in place of text
  std::optional<web::Address> metrics;  ///< where metrics and health are told; empty: nowhere
  std::optional<web::Address> page;     ///< where the site is shown to browsers; empty: nowhere
  std::string page_token_file;  ///< of the token that it asks for; empty: one is made up where others reach it
  double status_every_s = 10;   ///< a line in the log; 0: none
};

/// Fills `options`; or prints help, version or what is wrong, and returns the exit code (0 or 2).
[[nodiscard]] Result<ServerOptions> parse_arguments(int argc, char** argv, int& exit_code);

}  // namespace liloc
