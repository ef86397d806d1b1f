#include "proto-tests/bench/spot_bench_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

namespace liloc::bench {
namespace {

using Filter = std::function<bool(const Row&)>;

void print_heading(const char* title) {
  fmt::print("\n{}\n{:>10} {:>6} {:>9} {:>9} {:>9} {:>9} {:>9}\n", title, "", "spots", "10d 0.3m", "3d 0.1m",
             "verified", "wrong ver", "refused");
}

void print_line(const std::vector<Row>& rows, const std::string& name, const Filter& filter) {
  std::size_t n = 0, loose = 0, strict = 0, verified = 0, wrong = 0, refused = 0;
  for (const Row& r : rows) {
    if (!filter(r)) continue;
    ++n;
    loose += r.right();
    strict += r.within(3, 0.1);
    verified += r.reply.verified();
    wrong += r.reply.verified() && !r.right();
    refused += !r.reply.verified();
  }
  const auto share = [&](std::size_t k) {
    return n == 0 ? "-" : fmt::format("{:.1f}%", 100.0 * static_cast<double>(k) / static_cast<double>(n));
  };
  fmt::print("{:>10} {:>6} {:>9} {:>9} {:>9} {:>9} {:>9}\n", name, n, share(loose), share(strict),
             share(verified), wrong, share(refused));
}

}  // namespace

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

void print_success(const std::vector<Row>& rows, bool cold) {
  print_heading(cold ? "cold, by overlap" : "with history, by overlap");
  const auto line = [&](const std::string& name, double low, double high) {
    print_line(rows, name,
               [=](const Row& r) { return r.cold == cold && r.overlap >= low && r.overlap < high; });
  };
  for (int d = 0; d < 10; ++d)
    line(fmt::format("{:.1f}-{:.1f}", d / 10.0, (d + 1) / 10.0), d / 10.0, (d + 1) / 10.0 + (d == 9));
  line("over 0.3", 0.3, 2);
  line("all", -1, 2);
  std::vector<double> latency, cpu, prepare;
  for (const Row& r : rows) {
    if (r.cold != cold) continue;
    latency.push_back(r.reply.latency_ms);
    cpu.push_back(r.cpu_ms);
    prepare.push_back(r.prepare_ms);
  }
  const auto show = [](const char* what, const std::vector<double>& ms) {
    fmt::print("{}: median {:.1f} ms, p90 {:.1f} ms\n", what, percentile(ms, 0.5), percentile(ms, 0.9));
  };
  show("latency", latency);
  show("CPU time of the answering thread", cpu);
  show("CPU time of the room's preparation beside it", prepare);
}

void print_by_site(const std::vector<Row>& rows) {
  std::map<std::string, int> kinds;
  for (const Row& r : rows) ++kinds[r.site.substr(0, r.site.find(' '))];
  for (const bool cold : {true, false}) {
    print_heading(cold ? "cold, overlap over 0.3" : "with history, overlap over 0.3");
    for (const auto& [kind, count] : kinds)
      print_line(rows, kind, [&, name = kind](const Row& r) {
        return r.cold == cold && r.overlap >= 0.3 && r.site.starts_with(name);
      });
  }
}

void print_methods(const std::vector<Method>& methods) {
  fmt::print("\nside by side: share within 10 deg and 0.3 m / within 3 deg and 0.1 m\n{:>10} {:>6}", "overlap",
             "spots");
  for (const Method& m : methods) fmt::print(" {:>20}", m.name);
  const auto line = [&](const std::string& name, double low, double high) {
    const auto in_band = [&](const Row& r) { return r.overlap >= low && r.overlap < high; };
    const auto n = std::ranges::count_if(methods.front().rows, in_band);
    fmt::print("\n{:>10} {:>6}", name, n);
    for (const Method& m : methods) {
      const auto share = [&](double deg, double metres) {
        const auto good =
            std::ranges::count_if(m.rows, [&](const Row& r) { return in_band(r) && r.within(deg, metres); });
        return n == 0 ? "-" : fmt::format("{:.0f}", 100.0 * static_cast<double>(good) / static_cast<double>(n));
      };
      fmt::print(" {:>10} / {:<3}    ", share(10, 0.3), share(3, 0.1));
    }
  };
  for (int d = 0; d < 10; ++d)
    line(fmt::format("{:.1f}-{:.1f}", d / 10.0, (d + 1) / 10.0), d / 10.0, (d + 1) / 10.0 + (d == 9));
  line("over 0.3", 0.3, 2);
  for (const double share : {0.5, 0.9}) {
    fmt::print("\n{:>17}", share == 0.5 ? "median ms" : "p90 ms");
    for (const Method& m : methods) {
      std::vector<double> latency;
      for (const Row& r : m.rows) latency.push_back(r.reply.latency_ms);
      fmt::print(" {:>20.1f}", percentile(latency, share));
    }
  }
  fmt::print("\n");
}

Consistency consistency_of(const std::vector<Row>& rows) {
  constexpr double kLow = 1.237, kHigh = 14.449;  // 95 % of chi-squared with six degrees of freedom
  std::vector<double> nees;
  double sum = 0;
  for (const Row& r : rows)
    if (r.reply.verified() && r.right()) {  // a wrong answer has no covariance to speak of
      nees.push_back(r.nees);
      sum += std::min(r.nees, 100.0);
    }
  if (nees.empty()) return {};
  const auto inside = std::ranges::count_if(nees, [](double v) { return v >= kLow && v <= kHigh; });
  const auto count = static_cast<double>(nees.size());
  const auto not_beyond = std::ranges::count_if(nees, [](double v) { return v <= kHigh; });
  return {nees.size(), percentile(nees, 0.5), sum / count, static_cast<double>(inside) / count,
          static_cast<double>(not_beyond) / count};
}

void print_consistency(const std::vector<Row>& rows) {
  const Consistency c = consistency_of(rows);
  fmt::print(
      "\ncovariance of {} verified answers: NEES median {:.1f} (5.3 expected), mean {:.1f} (6), {:.0f} % "
      "within "
      "the 95 % bounds\n",
      c.count, c.median, c.mean, 100 * c.inside);
}

}  // namespace liloc::bench
