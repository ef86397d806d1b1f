#include "proto-tests/load/report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/quantile.hpp"

namespace liloc::load {
namespace {

constexpr double kTimeout_ms = 4000;  // of a client; RequestScheduleOptions::reply_timeout_ns

void count(const RequestRow& row, LoadReport& report) {
  ++report.planned;
  if (row.outcome != Outcome::unsent) ++report.sent;
  if (row.outcome > Outcome::unanswered) ++report.answered;
  if (row.outcome == Outcome::unanswered) ++report.unanswered;
  if (row.outcome == Outcome::verified) ++report.verified;
  if (row.outcome == Outcome::provisional) ++report.provisional;
  if (row.outcome == Outcome::refused) ++report.refused;
  if (row.outcome == Outcome::superseded) ++report.superseded;
  if (row.wrong) ++report.wrong_verified;
}

void add_latencies(const std::vector<RequestRow>& rows, LoadReport& report) {
  std::vector<double> all, tracked, lags;
  for (const RequestRow& row : rows) {
    // What the server's silence kept from being sent has waited as long as what it left unanswered.
    const double ms = row.outcome <= Outcome::unanswered ? kTimeout_ms : row.latency_ms;
    all.push_back(ms);
    lags.push_back(row.lag_ms);
    if (!row.of_lost) tracked.push_back(ms);
  }
  if (all.empty()) return;
  report.p50_ms = quantile(all, 0.5);
  report.p95_ms = quantile(all, 0.95);
  report.p99_ms = quantile(all, 0.99);
  report.p999_ms = quantile(all, 0.999);
  report.max_ms = quantile(all, 1);
  if (!lags.empty()) report.lag_ms_p99 = quantile(lags, 0.99);
  if (!tracked.empty()) report.tracked_p99_ms = quantile(tracked, 0.99);
}

void add_devices(const std::vector<DeviceRow>& devices, LoadReport& report) {
  double present_s = 0, available_s = 0;
  std::vector<double> found_s;
  for (const DeviceRow& device : devices) {
    present_s += device.present_s;
    available_s += device.available_s;
    report.rx_mb += 1e-6 * static_cast<double>(device.sent_bytes);
    report.tx_mb += 1e-6 * static_cast<double>(device.received_bytes);
    if (device.recovered_s < 0) continue;
    ++report.lost;
    if (std::isfinite(device.recovered_s)) found_s.push_back(device.recovered_s);
  }
  if (present_s > 0) report.availability = available_s / present_s;
  report.found_again = found_s.size();
  if (found_s.empty()) return;
  report.found_again_p50_s = median(found_s);
  report.found_again_max_s = quantile(found_s, 1);
}

nlohmann::ordered_json to_object(const LoadReport& r) {
  const auto told = [](const std::optional<double>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
  };
  return {{"clients", r.clients},
          {"seconds", r.seconds},
          {"requests",
           {{"planned", r.planned},
            {"sent", r.sent},
            {"answered", r.answered},
            {"verified", r.verified},
            {"provisional", r.provisional},
            {"refused", r.refused},
            {"superseded", r.superseded},
            {"unanswered", r.unanswered}}},
          {"wrong_verified", r.wrong_verified},
          {"availability", r.availability},
          {"latency_ms",
           {{"p50", r.p50_ms}, {"p95", r.p95_ms}, {"p99", r.p99_ms}, {"p999", r.p999_ms}, {"max", r.max_ms}}},
          {"server",
           {{"cpu_s", told(r.server_cpu_s)},
            {"rss_mb", told(r.server_rss_mb)},
            {"rx_mb", r.rx_mb},
            {"tx_mb", r.tx_mb}}},
          {"generator", {{"lag_ms_p99", r.lag_ms_p99}, {"cpu_s", r.generator_cpu_s}}},
          {"valid", r.valid},
          {"why", r.why}};
}

std::string share_of_core(const std::optional<double>& cpu_s, double seconds) {
  return cpu_s ? fmt::format("{:.0f} %", 100 * *cpu_s / seconds) : "-";
}

std::string row_of(const LoadReport& r) {
  const double planned = static_cast<double>(std::max<std::size_t>(r.planned, 1));
  const auto percent = [&](std::size_t n) {
    return fmt::format("{:.1f}", 100 * static_cast<double>(n) / planned);
  };
  return fmt::format(
      "{:>7} {:>8} {:>8} {:>7} {:>7} {:>6} {:>6} {:>5} {:>6.1f} {:>22} {:>7} {:>6} {:>7.1f} {:>6}\n", r.clients,
      r.planned, percent(r.verified), percent(r.provisional), percent(r.refused), percent(r.superseded),
      percent(r.unanswered), r.wrong_verified, 100 * r.availability,
      fmt::format("{:.0f} / {:.0f} / {:.0f}", r.p50_ms, r.p95_ms, r.p99_ms),
      share_of_core(r.server_cpu_s, r.seconds), r.server_rss_mb ? fmt::format("{:.0f}", *r.server_rss_mb) : "-",
      r.lag_ms_p99, fmt::format("{:.0f} %", 100 * r.generator_cpu_s / r.seconds));
}

std::string notes_of(const LoadReport& r) {
  std::string notes;
  if (r.planned > r.sent)
    notes += fmt::format("{} clients: {} requests found no server\n", r.clients, r.planned - r.sent);
  if (r.lost > 0)
    notes += fmt::format(
        "{} clients: {} of {} that lost their odometry were found again, median {:.1f} s, longest {:.1f} s; "
        "p99 of "
        "the others {:.0f} ms\n",
        r.clients, r.found_again, r.lost, r.found_again_p50_s, r.found_again_max_s, r.tracked_p99_ms);
  if (!r.valid) notes += fmt::format("{} clients: VOID: {}\n", r.clients, r.why);
  return notes;
}

}  // namespace

LoadReport summarize(int clients, double seconds, const Outcomes& outcomes) {
  LoadReport report;
  report.clients = clients;
  report.seconds = seconds;
  for (const RequestRow& row : outcomes.requests) count(row, report);
  add_latencies(outcomes.requests, report);
  add_devices(outcomes.devices, report);
  report.valid = report.sent > 0 && report.lag_ms_p99 <= kMostLag_ms;
  if (report.sent == 0)
    report.why = "no request was sent: no server was in sight";
  else if (!report.valid)
    report.why = fmt::format(
        "the generator was {:.1f} ms late at p99, over {:.0f} ms; use fewer clients, another machine or "
        "more --processes",
        report.lag_ms_p99, kMostLag_ms);
  return report;
}

std::string to_json(const std::vector<LoadReport>& reports) {
  if (reports.size() == 1) return to_object(reports.front()).dump(2) + "\n";
  auto all = nlohmann::ordered_json::array();
  for (const LoadReport& report : reports) all.push_back(to_object(report));
  return all.dump(2) + "\n";
}

std::string to_table(const std::vector<LoadReport>& reports) {
  std::string table =
      "Shares are % of planned requests; CPU is % of one core; lag and gen. are the generator's own.\n" +
      fmt::format("{:>7} {:>8} {:>8} {:>7} {:>7} {:>6} {:>6} {:>5} {:>6} {:>22} {:>7} {:>6} {:>7} {:>6}\n",
                  "clients", "requests", "verified", "prov.", "refused", "supers", "none", "wrong", "avail",
                  "ms p50 / p95 / p99", "server", "MB", "lag ms", "gen.");
  for (const LoadReport& report : reports) table += row_of(report);
  for (const LoadReport& report : reports) table += notes_of(report);
  return table;
}

}  // namespace liloc::load
