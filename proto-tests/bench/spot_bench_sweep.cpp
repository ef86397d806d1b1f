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

/// `verdict` of a row that is of a search, with a threshold in place of the default.
void sweep_odds(
    const char* title, double standard_odds, const std::vector<EvidenceRow>& rows,
    const std::function<std::optional<Outcome>(const EvidenceRow&, const VerifyOptions&)>& verdict) {
  print_heading(title, "logarithm of the odds");
  for (const double odds : {2.0, 3.0, 3.4, 4.0, 4.5, 5.0, 5.5, 6.0, 7.0}) {
    VerifyOptions o;
    o.log_odds = o.log_odds_few = odds;
    print_line(marked(fmt::format("{:.1f}", odds), odds == standard_odds), rows,
               [&](const EvidenceRow& r) -> std::optional<Outcome> {
                 if (r.live || !r.evidence.own) return std::nullopt;
                 return verdict(r, o);
               });
  }
}

void sweep_searching(const std::vector<EvidenceRow>& rows) {
  sweep_odds("One spot alone", VerifyOptions{}.log_odds_few, rows,
             [](const EvidenceRow& r, const VerifyOptions& o) {
               return Outcome{conclusive(r.evidence, o), r.own_right};
             });
  sweep_odds(
      "Three spots and more", VerifyOptions{}.log_odds, rows, [](const EvidenceRow& r, const VerifyOptions& o) {
        return r.evidence.spots < o.spots ? std::nullopt
                                          : std::optional(Outcome{confirmed(r.evidence, o), r.best_right});
      });
}

void sweep_following(const std::vector<EvidenceRow>& rows) {
  print_heading("Following a verified pose",
                "share of ceiling points that agree, share of judged device points that do");
  const VerifyOptions standard;
  for (const double map_agree : {0.90, 0.93, 0.96, 0.98})
    for (const double overlap : {0.93, 0.96, 0.98, 0.99}) {
      VerifyOptions o;
      o.followed_map_agree = map_agree;
      o.followed_overlap = overlap;
      print_line(marked(fmt::format("{:.2f}, {:.2f}", map_agree, overlap),
                        map_agree == standard.followed_map_agree && overlap == standard.followed_overlap),
                 rows, [&](const EvidenceRow& r) -> std::optional<Outcome> {
                   if (!r.live || !r.followed() || !r.evidence.best) return std::nullopt;
                   return Outcome{holds(r.evidence, o), r.best_right};
                 });
    }
}

}  // namespace

void print_sweep(const std::vector<EvidenceRow>& rows) {
  sweep_searching(rows);
  sweep_following(rows);
}

}  // namespace liloc::bench
