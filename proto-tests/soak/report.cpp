#include "proto-tests/soak/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace liloc::soak {
namespace {

struct Figure {
  const char* name;
  const char* unit;
  const Trend& trend;
  double most;  ///< that it may grow by
};

std::vector<Figure> figures_of(const ProcessReport& process) {
  return {{"memory", " MB", process.memory_mb, process.most_memory_mb},
          {"threads", "", process.threads, kMostThreads},
          {"descriptors", "", process.descriptors, kMostDescriptors}};
}

nlohmann::ordered_json to_object(const Trend& trend) {
  return {{"first", trend.first},
          {"last", trend.last},
          {"growth", trend.growth()},
          {"slope_per_h", trend.slope_per_h}};
}

double share_located(const std::vector<Visit>& visits, double from_s, std::size_t& count) {
  std::size_t located = 0;
  count = 0;
  for (const Visit& visit : visits)
    if (visit.from_s >= from_s && visit.to_s - visit.from_s >= kLongVisit_s) {
      ++count;
      if (visit.located()) ++located;
    }
  return count == 0 ? 0 : static_cast<double>(located) / static_cast<double>(count);
}

void judge_growth(SoakReport& report) {
  for (const ProcessReport& process : report.processes)
    for (const Figure& figure : figures_of(process))
      if (figure.trend.growth() > figure.most)
        report.failures.push_back(fmt::format("{}: {} grew from {:.1f} to {:.1f}{}; {:.1f} more are allowed",
                                              process.name, figure.name, figure.trend.first, figure.trend.last,
                                              figure.unit, figure.most));
}

/// Neither passed nor failed: null.
nlohmann::ordered_json verdict_of(const SoakReport& report) {
  if (report.failures.empty() && !report.judged) return nullptr;
  return report.failures.empty();
}

}  // namespace

ProcessReport summarize(const Watched& watched, double from_s) {
  return {watched.name, watched.most_memory_mb, trend_of(watched.memory_mb, from_s),
          trend_of(watched.threads, from_s), trend_of(watched.descriptors, from_s)};
}

void add_visits(const std::vector<Visit>& visits, SoakReport& report) {
  report.visits = visits.size();
  report.located_share = share_located(visits, report.judged_from_s, report.long_visits);
  const double last_s = report.seconds - (report.seconds - report.judged_from_s) / 3;
  report.last_located_share = share_located(visits, last_s, report.last_long_visits);
}

void judge(SoakReport& report) {
  report.judged = !report.processes.empty() && std::ranges::all_of(report.processes, [](const auto& process) {
    return process.memory_mb.third_s >= kLeastThird_s;
  });
  if (report.judged) judge_growth(report);
  if (report.answered == 0) report.failures.emplace_back("server: it answered nobody");
  if (report.silent_restarts > 0)
    report.failures.push_back(fmt::format("standby: {} of {} restarted servers answered nobody",
                                          report.silent_restarts, report.restarts));
  for (const auto& [share, count, when] :
       {std::tuple{report.located_share, report.long_visits, "in all"},
        std::tuple{report.last_located_share, report.last_long_visits, "in the last third"}})
    if (count > 0 && share < kLeastLocated)
      report.failures.push_back(
          fmt::format("visitors: {:.0f} % of {} long visits were located {}, fewer than {:.0f} %", 100 * share,
                      count, when, 100 * kLeastLocated));
  if (report.log_kb_per_min > kMostLogKbPerMin)
    report.failures.push_back(
        fmt::format("server: {:.0f} kB of log a minute, over {:.0f}", report.log_kb_per_min, kMostLogKbPerMin));
}

std::string to_json(const SoakReport& r) {
  auto processes = nlohmann::ordered_json::array();
  for (const ProcessReport& process : r.processes)
    processes.push_back({{"name", process.name},
                         {"memory_mb", to_object(process.memory_mb)},
                         {"threads", to_object(process.threads)},
                         {"descriptors", to_object(process.descriptors)}});
  const nlohmann::ordered_json json = {{"seconds", r.seconds},
                                       {"judged_from_s", r.judged_from_s},
                                       {"processes", processes},
                                       {"answered", r.answered},
                                       {"lidar_flaps", r.flaps},
                                       {"restarts", r.restarts},
                                       {"silent_restarts", r.silent_restarts},
                                       {"visits", r.visits},
                                       {"long_visits", r.long_visits},
                                       {"located_share", r.located_share},
                                       {"last_located_share", r.last_located_share},
                                       {"log_kb_per_min", r.log_kb_per_min},
                                       {"judged", r.judged},
                                       {"passed", verdict_of(r)},
                                       {"why", r.failures}};
  return json.dump(2) + "\n";
}

std::string to_table(const SoakReport& r) {
  std::string table = fmt::format(
      "Floors of the first and last third of {:.0f} s after {:.0f} s of warm-up; memory is a process's own.\n"
      "{:<12} {:>22} {:>9} {:>14} {:>16}\n",
      r.seconds - r.judged_from_s, r.judged_from_s, "", "memory MB", "MB/h", "threads", "descriptors");
  for (const ProcessReport& p : r.processes)
    table +=
        fmt::format("{:<12} {:>22} {:>9.1f} {:>14} {:>16}\n", p.name,
                    fmt::format("{:.1f} -> {:.1f}", p.memory_mb.first, p.memory_mb.last),
                    p.memory_mb.slope_per_h, fmt::format("{:.0f} -> {:.0f}", p.threads.first, p.threads.last),
                    fmt::format("{:.0f} -> {:.0f}", p.descriptors.first, p.descriptors.last));
  table += fmt::format(
      "{} visits, {:.0f} % of {} long ones located; {} times a LiDAR went, {} times the standby; {} answers; "
      "{:.1f} kB of log a minute\n",
      r.visits, 100 * r.located_share, r.long_visits, r.flaps, r.restarts, r.answered, r.log_kb_per_min);
  for (const std::string& failure : r.failures) table += failure + "\n";
  if (!r.judged)
    return table +
           fmt::format("too short to judge whether anything grows: give --seconds {:.0f} or more\n", kJudged_s);
  return table + (r.failures.empty() ? "nothing grew\n" : "");
}

std::string samples_csv(const std::vector<Watched>& watched) {
  std::string csv = "at_s,process,memory_mb,threads,descriptors\n";
  for (const Watched& process : watched)
    for (std::size_t i = 0; i < process.memory_mb.size(); ++i)
      csv += fmt::format("{:.1f},{},{:.2f},{:.0f},{:.0f}\n", process.memory_mb[i].at_s, process.name,
                         process.memory_mb[i].value, process.threads[i].value, process.descriptors[i].value);
  return csv;
}

std::string visits_csv(const std::vector<Visit>& visits) {
  std::string csv = "from_s,to_s,located_after_s,frames,requests,replies,verified\n";
  for (const Visit& v : visits)
    csv += fmt::format("{:.2f},{:.2f},{},{},{},{},{}\n", v.from_s, v.to_s,
                       v.located() ? fmt::format("{:.2f}", v.located_after_s) : "", v.frames, v.requests,
                       v.replies, v.verified);
  return csv;
}

}  // namespace liloc::soak
