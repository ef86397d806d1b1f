#include "proto-tests/faults/verdict.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "proto-tests/replay/evaluation.hpp"

namespace liloc::faults {
namespace {

void judge_replies(const Scenario& scenario, const Performed& performed, Verdict& verdict) {
  double last_s = 0, gap_s = 0;
  std::vector<double> answers_s;
  for (const ReplyRow& reply : performed.story.replies) {
    ++verdict.replies;
    answers_s.push_back(reply.at_s - reply.frame_s);
    verdict.wrong += reply.wrong;
    if (!reply.verified) continue;
    ++verdict.verified;
    if (!verdict.first_s) verdict.first_s = last_s = reply.at_s;
    gap_s = std::max(gap_s, reply.at_s - last_s);
    last_s = std::max(last_s, reply.at_s);
    const auto& over_s = performed.times.over_s;
    if (over_s && reply.frame_s >= *over_s && !verdict.recovery_s) verdict.recovery_s = reply.at_s - *over_s;
  }
  verdict.answer_s = replay::percentile(answers_s, 0.5);
  verdict.late_answer_s = replay::percentile(answers_s, 0.95);
  if (verdict.first_s) verdict.gap_s = std::max(gap_s, scenario.seconds - last_s);
}

void judge_frames(const Performed& performed, Verdict& verdict) {
  for (const FrameRow& frame : performed.story.frames) {
    if (!verdict.first_s || frame.frame_s < *verdict.first_s) continue;
    ++verdict.frames;
    verdict.located += frame.located;
    verdict.lost += frame.lost;
    if (!frame.located || frame.lost) continue;
    verdict.worst_m = std::max(verdict.worst_m, frame.error_m);
    verdict.worst_deg = std::max(verdict.worst_deg, frame.error_deg);
  }
}

/// Median, and the worst of several.
std::string summary(const std::vector<Verdict>& runs, std::optional<double> Verdict::*figure, bool asked) {
  std::vector<double> values;
  for (const Verdict& run : runs)
    if (run.*figure) values.push_back(*(run.*figure));
  if (!asked) return "-";
  if (values.size() < runs.size())
    return runs.size() > 1 ? fmt::format("never in {}", runs.size() - values.size()) : "never";
  const double median = *replay::percentile(values, 0.5);
  if (runs.size() == 1) return fmt::format("{:.2f} s", median);
  return fmt::format("{:.2f} s ({:.2f})", median, *std::ranges::max_element(values));
}

Verdict sum_of(const std::vector<Verdict>& runs) {
  Verdict sum;
  for (const Verdict& run : runs) {
    sum.requests += run.requests;
    sum.unanswered += run.unanswered;
    sum.verified += run.verified;
    sum.wrong += run.wrong;
    sum.frames += run.frames;
    sum.located += run.located;
    sum.lost += run.lost;
    sum.worst_m = std::max(sum.worst_m, run.worst_m);
    sum.worst_deg = std::max(sum.worst_deg, run.worst_deg);
    sum.frames_lost += run.frames_lost / static_cast<double>(runs.size());
  }
  return sum;
}

std::string row(const std::vector<Verdict>& runs) {
  const Verdict sum = sum_of(runs);
  const auto share = [&](std::size_t part) {
    return sum.frames > 0
               ? fmt::format("{:.0f} %", 100.0 * static_cast<double>(part) / static_cast<double>(sum.frames))
               : "-";
  };
  const std::string cells[] = {runs.front().scenario,
                               std::to_string(runs.size()),
                               fmt::format("{:.1f} %", 100 * sum.frames_lost),
                               std::to_string(sum.requests),
                               std::to_string(sum.unanswered),
                               std::to_string(sum.verified),
                               std::to_string(sum.wrong),
                               summary(runs, &Verdict::answer_s, true),
                               summary(runs, &Verdict::late_answer_s, true),
                               summary(runs, &Verdict::first_s, true),
                               summary(runs, &Verdict::gap_s, true),
                               summary(runs, &Verdict::recovery_s, runs.front().recovers),
                               share(sum.located),
                               share(sum.lost),
                               fmt::format("{:.0f} cm, {:.1f} deg", 100 * sum.worst_m, sum.worst_deg)};
  std::string line = "|";
  for (const std::string& cell : cells) line += " " + cell + " |";
  return line + "\n";
}

}  // namespace

Verdict judge(const Scenario& scenario, const Performed& performed) {
  Verdict verdict;
  verdict.scenario = scenario.name;
  verdict.requests = performed.story.requests;
  verdict.unanswered = performed.story.unanswered + performed.story.unsent;
  verdict.recovers = performed.times.over_s.has_value();
  const auto& [carried, lost] = performed.frames;
  verdict.frames_lost =
      static_cast<double>(lost) / static_cast<double>(std::max<std::uint64_t>(carried + lost, 1));
  judge_replies(scenario, performed, verdict);
  judge_frames(performed, verdict);
  return verdict;
}

std::string to_table(const std::vector<Verdict>& verdicts) {
  constexpr const char* kColumns[] = {"scenario",
                                      "runs",
                                      "lost on the device's link",
                                      "requests",
                                      "unanswered",
                                      "verified",
                                      "wrong",
                                      "answered after",
                                      "p95",
                                      "first verified",
                                      "longest without",
                                      "verified again after",
                                      "frames with a pose",
                                      "told lost",
                                      "worst pose"};
  std::string table = "|", rule = "|";
  for (const char* column : kColumns) {
    table += fmt::format(" {} |", column);
    rule += " --- |";
  }
  table += "\n" + rule + "\n";
  std::vector<std::string> names;
  for (const Verdict& verdict : verdicts)
    if (std::ranges::find(names, verdict.scenario) == names.end()) names.push_back(verdict.scenario);
  for (const std::string& name : names) {
    std::vector<Verdict> runs;
    std::ranges::copy_if(verdicts, std::back_inserter(runs),
                         [&](const Verdict& v) { return v.scenario == name; });
    table += row(runs);
  }
  return table;
}

std::string to_json(const std::vector<Verdict>& verdicts) {
  const auto or_null = [](const std::optional<double>& figure) {
    return figure ? nlohmann::json(*figure) : nlohmann::json();
  };
  nlohmann::json runs = nlohmann::json::array();
  for (const Verdict& v : verdicts)
    runs.push_back({{"scenario", v.scenario},
                    {"requests", v.requests},
                    {"unanswered", v.unanswered},
                    {"replies", v.replies},
                    {"verified", v.verified},
                    {"verified_wrong", v.wrong},
                    {"answer_s", or_null(v.answer_s)},
                    {"late_answer_s", or_null(v.late_answer_s)},
                    {"first_s", or_null(v.first_s)},
                    {"gap_s", or_null(v.gap_s)},
                    {"recovery_s", or_null(v.recovery_s)},
                    {"frames", v.frames},
                    {"frames_located", v.located},
                    {"frames_told_lost", v.lost},
                    {"worst_m", v.worst_m},
                    {"worst_deg", v.worst_deg},
                    {"network_frames_lost", v.frames_lost},
                    {"good", v.good()}});
  return nlohmann::json({{"runs", runs}}).dump(1) + "\n";
}

}  // namespace liloc::faults
