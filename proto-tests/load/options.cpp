#include "proto-tests/load/options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace liloc::load {
namespace {

constexpr int kMostClients = 1000;  // by hand

Status within(double value, double low, double high, const char* name) {
  if (value >= low && value <= high) return {};  // NaN is not
  return fail("load: --{} is {}, must be {}..{}", name, value, low, high);
}

std::optional<int> whole(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

Status LoadOptions::validated() const {
  if (clients.empty()) return fail("load: --clients names no count; give one or several, 1..{}", kMostClients);
  for (const int count : clients)
    if (const Status ok = within(count, 1, kMostClients, "clients"); !ok) return ok;
  for (const Status& ok : {within(seconds, 2, 3600, "seconds"), within(interval_ms, 100, 10'000, "interval-ms"),
                           within(people, 0, 30, "people"), within(lidars, 1, 8, "lidars"),
                           within(lidar_rate_hz, 1, 30, "lidar-rate"), within(paths, 1, 16, "paths"),
                           within(path_s, 4, 120, "path-seconds"), within(processes, 1, 64, "processes"),
                           within(lost_share, 0, 1, "lost-share"), within(kidnap_s, 0, 3600, "kidnap"),
                           within(churn_s, 0, 3600, "churn"), within(frame_loss, 0, 0.9, "frame-loss"),
                           within(clock_offset_s, 0, 3600, "clock-offset"), within(freeze_s, 0, 60, "freeze"),
                           within(domain, -1, 230, "domain")})
    if (!ok) return ok;
  if (churn_s > 0 && churn_s < 2) return fail("load: --churn is {}, must be 0 or 2 s and more", churn_s);
  if (kidnap_s > 0 && kidnap_s < 1) return fail("load: --kidnap is {}, must be 0 or 1 s and more", kidnap_s);
  if (freeze_s > seconds / 2)
    return fail("load: --freeze is {}, must be half of --seconds at most: it begins in the middle", freeze_s);
  if (freeze_s > 0 && domain >= 0)
    return fail("load: --freeze stops a server that this run started; leave --domain out");
  if (domain < 0 && !server.empty())
    return fail("load: --server needs --domain, the DDS domain of the server that runs there");
  if (domain >= 0 && !server_options.empty())
    return fail("load: --server-option is for a server that this run starts; leave --domain out");
  return {};
}

Result<std::vector<int>> ramp_of(const std::string& text) {
  const auto colon = text.find(':');
  const auto first = whole(std::string_view(text).substr(0, colon));
  const auto last = colon == std::string::npos ? std::nullopt : whole(std::string_view(text).substr(colon + 1));
  if (!first || !last || *first < 1 || *last < *first || *last > kMostClients)
    return fail("load: --ramp must be FIRST:LAST, two counts from 1 to {}, the smaller first", kMostClients);
  std::vector<int> counts{*first};
  for (int decade = 1; decade <= kMostClients; decade *= 10)
    for (const int step : {1, 2, 5})
      if (step * decade > *first && step * decade < *last) counts.push_back(step * decade);
  if (*last > *first) counts.push_back(*last);
  return counts;
}

}  // namespace liloc::load
