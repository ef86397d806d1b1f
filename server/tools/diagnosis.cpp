#include "server/tools/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace liloc::toolbox {
namespace {

Finding check_lidar(const wire::LidarHealth& lidar, const std::string& server) {
  Finding finding;
  finding.what =
      fmt::format("{}: {} {} at {:.1f} Hz", server, lidar.id, name_of(lidar.state), lidar.measured_hz);
  switch (lidar.state) {
    case wire::LidarState::ok:
      break;
    case wire::LidarState::slow:
      finding.verdict = Verdict::doubtful;
      finding.remedy = "under half of its rate_hz in site.json: look at its network, or correct rate_hz";
      break;
    case wire::LidarState::waiting:
    case wire::LidarState::silent:
      finding.verdict = Verdict::bad;
      finding.remedy = fmt::format(
          "does its driver run, send rt/{}/depth/image_rect_raw in this domain, and name the server's host as "
          "peer?",
          lidar.id);
      break;
    case wire::LidarState::malformed:
      finding.verdict = Verdict::bad;
      finding.remedy = "its frames are refused: " + lidar.last_error;
      break;
  }
  return finding;
}

/// What the site names and the server does not.
std::vector<Finding> check_site(const wire::ServerStatus& server, const Site& site) {
  std::vector<Finding> findings;
  for (const auto& lidar : site.global_lidars)
    if (std::ranges::none_of(server.lidars, [&](const auto& known) { return known.id == lidar.id; }))
      findings.push_back({Verdict::bad, fmt::format("{}: does not serve {}", server.server_id, lidar.id),
                          "it was started with another site.json: start it again with this one"});
  return findings;
}

Finding check_answers(const wire::ServerStatus& server) {
  Finding finding{
      Verdict::good,
      fmt::format("{}: up for {:.0f} s, {} clients, {} answered ({} verified, {} refused), {} waiting",
                  server.server_id, server.uptime_s, server.clients, server.answered, server.verified,
                  server.refused, server.queued)};
  if (2 * server.refused > server.answered && server.answered > 0) {
    finding.verdict = Verdict::doubtful;
    finding.remedy = "most requests are refused: the clients' traces (spots.csv) and logs say why";
  }
  return finding;
}

}  // namespace

Finding check_setting(const std::string& name, std::optional<long> value, long wanted) {
  if (!value) return {Verdict::doubtful, name + " cannot be read", "look at it by hand: sysctl " + name};
  if (*value >= wanted) return {Verdict::good, fmt::format("{} is {}", name, *value)};
  return {Verdict::doubtful, fmt::format("{} is {}, bursts of depth frames may be lost", name, *value),
          fmt::format("sysctl -w {}={}, or 60-liloc.conf for good", name, wanted)};
}

std::vector<Finding> check_servers(const std::vector<wire::ServerStatus>& servers,
                                   const std::optional<Site>& site) {
  if (servers.empty())
    return {
        {Verdict::bad, "no server is heard",
         "does one run in this --domain, on a host that --peer names, with an --interface that reaches here?"}};
  std::vector<Finding> findings;
  for (const auto& server : servers) {
    findings.push_back(check_answers(server));
    for (const auto& lidar : server.lidars) findings.push_back(check_lidar(lidar, server.server_id));
    if (!site) continue;
    for (auto& finding : check_site(server, *site)) findings.push_back(std::move(finding));
  }
  return findings;
}

std::string line_of(const Finding& finding) {
  const char* verdict = finding.verdict == Verdict::good       ? "ok  "
                        : finding.verdict == Verdict::doubtful ? "warn"
                                                               : "FAIL";
  return fmt::format("{}  {}{}", verdict, finding.what, finding.remedy.empty() ? "" : "; " + finding.remedy);
}

}  // namespace liloc::toolbox
