#pragma once
#include "server/web/facts.hpp"
#include "server/web/web_server.hpp"

namespace liloc::web {

/// Does the server live? 200, or 503 where its network thread has hung for 5 s, or a worker over one request
/// for 10 s: it is to be started anew.
[[nodiscard]] Page live_page(const ServerFacts& facts);

/// Can it answer devices? 200, or 503 and why not: no ceiling LiDAR is heard, or it does not live.
[[nodiscard]] Page ready_page(const ServerFacts& facts);

}  // namespace liloc::web
