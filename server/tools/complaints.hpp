#pragma once
// Every line that `liloc doctor` can say of what it sees, in one table: deploy/TROUBLESHOOTING.md lists the
// same, and a test holds both together.
#include <fmt/format.h>

#include <array>
#include <string>
#include <string_view>

#include "server/tools/diagnosis.hpp"

namespace liloc::toolbox {

/// `what` and `remedy` hold fields by name, as in "{server}: {lidar} is blind".
struct Complaint {
  std::string_view name;
  Verdict verdict;
  std::string_view what, remedy;
};

inline constexpr std::array kComplaints{
    Complaint{"setting_unread", Verdict::doubtful, "{setting} cannot be read",
              "look at it by hand: sysctl {setting}"},
    Complaint{"setting_small", Verdict::doubtful, "{setting} is {value}, bursts of depth frames may be lost",
              "sysctl -w {setting}={wanted}, or 60-liloc.conf for good"},
    Complaint{"file", Verdict::bad, "{error}", ""},
    Complaint{"credentials_unusable", Verdict::bad, "credentials cannot be used: {error}", ""},
    Complaint{"credentials_end", Verdict::bad, "the credentials of {name} expire in {days} days",
              "deploy/credentials renew {name}, and copy its folder again"},
    Complaint{"credentials_exposed", Verdict::bad, "{file} can be read by others than its owner",
              "chmod 600 {file}; if strangers had access: deploy/credentials revoke, then renew"},
    Complaint{"network", Verdict::bad, "the network cannot be used: {error}",
              "look at --interface and --domain"},
    Complaint{
        "no_server", Verdict::bad, "no server is heard in domain {domain}, interface {interface}",
        "does one run in this --domain, on a host that --peer names, with an --interface that reaches here?"},
    Complaint{"unreadable_status", Verdict::bad, "a server's status cannot be read: {error}",
              "is it of this version? update the older one"},
    Complaint{"most_refused", Verdict::doubtful, "{server}: {refused} of {answered} requests are refused",
              "the clients' problem, traces (spots.csv) and logs say why"},
    Complaint{"another_site", Verdict::bad, "{server}: does not serve {lidar}",
              "it was started with another site.json: start it again with this one"},
    Complaint{"slow", Verdict::doubtful, "{server}: {lidar} is slow, {hz:.1f} Hz",
              "under half of its rate_hz in site.json: look at its network, or correct rate_hz"},
    Complaint{"waiting", Verdict::bad, "{server}: {lidar} has sent nothing yet",
              "does its driver run, send rt/{topic}/depth/image_rect_raw in this domain, and name the server's "
              "host as "
              "peer?"},
    Complaint{"silent", Verdict::bad, "{server}: {lidar} is silent",
              "does its driver run, send rt/{topic}/depth/image_rect_raw in this domain, and name the server's "
              "host as "
              "peer?"},
    Complaint{"malformed", Verdict::bad, "{server}: {lidar} sends malformed frames",
              "they are refused: {error}"},
    Complaint{"blind", Verdict::bad,
              "{server}: {lidar} is blind, {returns:.1f} % of its pixels measure anything",
              "is its lens covered, its laser on, and its depth stream the one that is published?"},
    Complaint{
        "implausible", Verdict::bad,
        "{server}: {lidar} measures implausible ranges, {range:.3g} m in the median{usual}",
        "is its depth_scale in site.json the driver's unit, and nothing right before its lens? if the room has "
        "changed so much, start the server again"},
    Complaint{
        "clock_off", Verdict::bad, "{server}: {lidar} has another clock, {offset:.2f} s {side} the site's",
        "its frames are left out as the offset does not hold steady: set the clock of its host by NTP or PTP, "
        "or stamps to nanoseconds of one clock"},
    Complaint{"clock_corrected", Verdict::doubtful,
              "{server}: {lidar} has a clock {offset:.2f} s {side} the site's, which is corrected",
              "correct to some hundredths of a second: set the clock of its host by NTP or PTP"},
    Complaint{"state_unknown", Verdict::doubtful,
              "{server}: {lidar} is in state {number}, which this program does not know",
              "the server is newer: update this program"},
};

[[nodiscard]] consteval std::size_t complaint(std::string_view name) {
  for (std::size_t i = 0; i < kComplaints.size(); ++i)
    if (kComplaints.at(i).name == name) return i;
  throw "there is no such complaint";  // at compile time
}

/// A finding of the table, its fields filled in: `finding<complaint("blind")>(fmt::arg("server", ...), ...)`.
template <std::size_t Index, class... Fields>
[[nodiscard]] Finding finding(const Fields&... fields) {
  constexpr Complaint said = kComplaints.at(Index);
  return {said.verdict, fmt::format(fmt::runtime(said.what), fields...),
          fmt::format(fmt::runtime(said.remedy), fields...)};
}

}  // namespace liloc::toolbox
