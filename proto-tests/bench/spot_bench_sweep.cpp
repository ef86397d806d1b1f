#include "proto-tests/bench/spot_bench_sweep.hpp"

#include <fmt/format.h>

#include <functional>

namespace liloc::bench {
namespace {

void print_heading(const char* title, const char* threshold) {
  fmt::print(
      "\n**{}**\n\n| {} | spots | verified | wrong of them | refused, overlap over 0.3 "
      "|\n|---|---|---|---|---|\n",
      title, threshold);
}

/// `verdict`: empty where the row has no part; otherwise whether it would be verified, and was right.
struct Outcome {
  bool verified, right;
};
using Judge = std::function<std::optional<Outcome>(const EvidenceRow&)>;

void print_line(const std::string& name, const std::vector<EvidenceRow>& rows, const Judge& judge) {
  std::size_t spots = 0, verified = 0, wrong = 0, seen = 0, refused = 0;
  for (const EvidenceRow& row : rows) {
    const auto verdict = judge(row);
    if (!verdict) continue;
    ++spots;
    verified += verdict->verified;
    wrong += verdict->verified && !verdict->right;
    seen += row.overlap >= 0.3;
    refused += row.overlap >= 0.3 && !verdict->verified;
  }
  const auto share = [](std::size_t part, std::size_t all) {
    return all == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(all);
  };
  fmt::print("| {} | {} | {} | {} ({:.2f} %) | {:.1f} % |\n", name, spots, verified, wrong,
             share(wrong, verified), share(refused, seen));
}

std::string marked(const std::string& name, bool is_default) {
  return is_default ? fmt::format("**{}**", name) : name;
}

void sweep_cold(const std::vector<EvidenceRow>& rows) {
  print_heading("One spot alone", "margin over the runner-up, share seen, share of it that agrees");
  const VerifyOptions standard;
  for (const double margin : {0.15, 0.45, 0.75})
    for (const double agree : {0.3, 0.45})
      for (const double overlap : {0.97, 0.985, 0.99}) {
        VerifyOptions o;
        o.conclusive_margin = margin;
        o.conclusive_agree = agree;
        o.conclusive_overlap = overlap;
        print_line(marked(fmt::format("{:.2f}, {:.2f}, {:.3f}", margin, agree, overlap),
                          margin == standard.conclusive_margin && agree == standard.conclusive_agree &&
                              overlap == standard.conclusive_overlap),
                   rows, [&](const EvidenceRow& r) -> std::optional<Outcome> {
                     if (r.live || !r.evidence.own) return std::nullopt;
                     return Outcome{conclusive(r.evidence, o), r.own_right};
                   });
      }
}

void sweep_searching(const std::vector<EvidenceRow>& rows) {
  print_heading("Several spots, not yet located",
                "lead per spot, share of device points on seen surfaces, share of ceiling points that agree");
  const VerifyOptions standard;
  for (const double lead : {0.0, 0.08, 0.2})
    for (const double agree : {0.12, 0.3, 0.35, 0.45})
      for (const double map_agree : {0.93, 0.96, 0.98}) {
        VerifyOptions o;
        o.lead_per_spot = lead;
        o.confirmed_agree = agree;
        o.confirmed_map_agree = map_agree;
        o.verified_map_agree = std::min(map_agree, standard.verified_map_agree);
        print_line(marked(fmt::format("{:.2f}, {:.2f}, {:.2f}", lead, agree, map_agree),
                          lead == standard.lead_per_spot && agree == standard.confirmed_agree &&
                              map_agree == standard.confirmed_map_agree),
                   rows, [&](const EvidenceRow& r) -> std::optional<Outcome> {
                     if (r.live || !r.evidence.best) return std::nullopt;
                     return Outcome{confirmed(r.evidence, o).has_value(), r.best_right};
                   });
      }
}

void sweep_following(const std::vector<EvidenceRow>& rows) {
  print_heading("Following a verified pose",
                "share of ceiling points that agree, share of judged device points that do");
  const VerifyOptions standard;
  for (const double map_agree : {0.90, 0.93, 0.96, 0.98})
    for (const double overlap : {0.93, 0.96, 0.98, 0.99}) {
      VerifyOptions o;
      o.verified_map_agree = map_agree;
      o.verified_overlap = overlap;
      print_line(marked(fmt::format("{:.2f}, {:.2f}", map_agree, overlap),
                        map_agree == standard.verified_map_agree && overlap == standard.verified_overlap),
                 rows, [&](const EvidenceRow& r) -> std::optional<Outcome> {
                   if (!r.live || !r.followed() || !r.evidence.best) return std::nullopt;
                   return Outcome{holds(r.evidence, o), r.best_right};
                 });
    }
}

}  // namespace

void print_sweep(const std::vector<EvidenceRow>& rows) {
  sweep_cold(rows);
  sweep_searching(rows);
  sweep_following(rows);
}

}  // namespace liloc::bench
