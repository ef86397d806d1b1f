#include "server/tools/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "common/base/ros_name.hpp"
#include "common/command/text.hpp"
#include "server/tools/complaints.hpp"

namespace liloc::toolbox {
namespace {

template <std::size_t Index>
using Of = std::integral_constant<std::size_t, Index>;
constexpr Of<complaint("slow")> kSlow;
constexpr Of<complaint("waiting")> kWaiting;
constexpr Of<complaint("silent")> kSilent;
constexpr Of<complaint("malformed")> kMalformed;
constexpr Of<complaint("blind")> kBlind;
constexpr Of<complaint("implausible")> kImplausible;
constexpr Of<complaint("clock_off")> kClockOff;
constexpr Of<complaint("clock_corrected")> kClockCorrected;
constexpr Of<complaint("state_unknown")> kStateUnknown;

Finding check_lidar(const wire::LidarHealth& lidar, const std::string& server) {
  const auto about = [&]<std::size_t Which>(std::integral_constant<std::size_t, Which>) {
    return finding<Which>(
        fmt::arg("server", server), fmt::arg("lidar", lidar.id), fmt::arg("topic", ros_name(lidar.id)),
        fmt::arg("hz", lidar.measured_hz), fmt::arg("error", lidar.last_error),
        fmt::arg("returns", 100 * lidar.returns), fmt::arg("range", lidar.range_m),
        fmt::arg("usual",
                 lidar.usual_range_m > 0 ? fmt::format(", it used to be {:.3g} m", lidar.usual_range_m) : ""),
        fmt::arg("offset", std::abs(lidar.clock_offset_s)),
        fmt::arg("side", lidar.clock_offset_s > 0 ? "ahead of" : "behind"),
        fmt::arg("number", static_cast<int>(lidar.state)));
  };
  switch (lidar.state) {
    case wire::LidarState::ok:
      if (lidar.clock_corrected) return about(kClockCorrected);
      return {Verdict::good, fmt::format("{}: {} ok at {:.1f} Hz", server, lidar.id, lidar.measured_hz)};
    case wire::LidarState::slow:
      return about(kSlow);
    case wire::LidarState::waiting:
      return about(kWaiting);
    case wire::LidarState::silent:
      return about(kSilent);
    case wire::LidarState::malformed:
      return about(kMalformed);
    case wire::LidarState::blind:
      return about(kBlind);
    case wire::LidarState::implausible:
      return about(kImplausible);
    case wire::LidarState::clock_off:
      return about(kClockOff);
  }
  return about(kStateUnknown);
}

/// What the site names and the server does not.
std::vector<Finding> check_site(const wire::ServerStatus& server, const Site& site) {
  std::vector<Finding> findings;
  for (const auto& lidar : site.global_lidars)
    if (std::ranges::none_of(server.lidars, [&](const auto& known) { return known.id == lidar.id; }))
      findings.push_back(finding<complaint("another_site")>(fmt::arg("server", server.server_id),
                                                            fmt::arg("lidar", lidar.id)));
  return findings;
}

std::vector<Finding> check_answers(const wire::ServerStatus& server) {
  std::vector<Finding> findings{
      {Verdict::good,
       fmt::format("{}: up for {:.0f} s, {} clients, {} answered ({} verified, {} refused), {} waiting",
                   server.server_id, server.uptime_s, server.clients, server.answered, server.verified,
                   server.refused, server.queued)}};
  if (2 * server.refused > server.answered && server.answered > 0)
    findings.push_back(finding<complaint("most_refused")>(fmt::arg("server", server.server_id),
                                                          fmt::arg("refused", server.refused),
                                                          fmt::arg("answered", server.answered)));
  return findings;
}

}  // namespace

Finding check_setting(const std::string& name, std::optional<long> value, long wanted) {
  if (!value) return finding<complaint("setting_unread")>(fmt::arg("setting", name));
  if (*value >= wanted) return {Verdict::good, fmt::format("{} is {}", name, *value)};
  return finding<complaint("setting_small")>(fmt::arg("setting", name), fmt::arg("value", *value),
                                             fmt::arg("wanted", wanted));
}

Finding unreadable_file(const Error& error) {
  return finding<complaint("file")>(fmt::arg("error", error.message));
}

Finding unusable_network(const Error& error) {
  return finding<complaint("network")>(fmt::arg("error", error.message));
}

std::vector<Finding> check_credentials(const Result<Credentials>& credentials,
                                       std::chrono::system_clock::time_point now) {
  if (!credentials)
    return {finding<complaint("credentials_unusable")>(fmt::arg("error", credentials.error().message))};
  const auto name = fmt::arg("name", credentials->name);
  const int days = days_left(*credentials, now);
  std::vector<Finding> findings;
  if (days < kRenewDays)
    findings.push_back(finding<complaint("credentials_end")>(name, fmt::arg("days", days)));
  if (credentials->key_exposed)
    findings.push_back(
        finding<complaint("credentials_exposed")>(fmt::arg("file", credentials->key().string())));
  if (findings.empty())
    findings.push_back({Verdict::good, fmt::format("credentials of {} {}, valid for {} days", credentials->kind,
                                                   credentials->name, days)});
  return findings;
}

std::vector<Finding> check_servers(const Heard& heard, const wire::DomainOptions& seat,
                                   const std::optional<Site>& site) {
  std::vector<Finding> findings;
  for (const std::string& error : heard.unreadable)
    findings.push_back(finding<complaint("unreadable_status")>(fmt::arg("error", error)));
  if (heard.servers.empty() && heard.unreadable.empty())
    findings.push_back(finding<complaint("no_server")>(fmt::arg("domain", seat.domain),
                                                       fmt::arg("interface", seat.interface)));
  for (const auto& server : heard.servers) {
    for (auto& finding : check_answers(server)) findings.push_back(std::move(finding));
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
  return command::one_line(
      fmt::format("{}  {}{}", verdict, finding.what, finding.remedy.empty() ? "" : "; " + finding.remedy));
}

}  // namespace liloc::toolbox
