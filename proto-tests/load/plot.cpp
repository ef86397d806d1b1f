#include "proto-tests/load/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace liloc::load {
namespace {

constexpr double kWidth = 640, kHeight = 400, kLeft = 60, kRight = 90, kTop = 30, kBottom = 50;

/// One axis: values to pixels, logarithmic.
struct Axis {
  double low, high, from_px, to_px;
  [[nodiscard]] double px(double value) const {
    const double share = std::log(std::clamp(value, low, high) / low) / std::log(high / low);
    return from_px + share * (to_px - from_px);
  }
};

struct Curve {
  const char *name, *colour;
  double LoadReport::*value;
};
constexpr std::array<Curve, 3> kCurves{{{"p50", "#2a7", &LoadReport::p50_ms},
                                        {"p95", "#27a", &LoadReport::p95_ms},
                                        {"p99", "#a33", &LoadReport::p99_ms}}};

std::string text(double x, double y, const char* anchor, const std::string& words) {
  return fmt::format(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}">{}</text>)", x, y, anchor, words) + "\n";
}

std::string grid(const Axis& x, const Axis& y) {
  std::string svg;
  for (double decade = y.low; decade <= y.high * 1.001; decade *= 10) {
    svg += fmt::format(R"(<path d="M{:.1f} {:.1f}H{:.1f}" stroke="#ddd"/>)", x.from_px, y.px(decade), x.to_px);
    svg += text(x.from_px - 6, y.px(decade) + 4, "end", fmt::format("{:g}", decade));
  }
  return svg;
}

std::string curve(const std::vector<LoadReport>& reports, const Curve& curve, const Axis& x, const Axis& y) {
  std::string points, dots;
  for (const LoadReport& r : reports) {
    const double px = x.px(r.clients), py = y.px(r.*curve.value);
    points += fmt::format("{:.1f},{:.1f} ", px, py);
    dots += fmt::format(R"(<circle cx="{:.1f}" cy="{:.1f}" r="3" fill="{}"/>)", px, py,
                        r.valid ? curve.colour : "#fff");
  }
  const LoadReport& last = reports.back();
  return fmt::format(R"(<polyline points="{}" fill="none" stroke="{}" stroke-width="2"/>{})", points,
                     curve.colour, dots) +
         text(x.px(last.clients) + 8, y.px(last.*curve.value) + 4, "start", curve.name);
}

}  // namespace

std::optional<int> knee_of(const std::vector<LoadReport>& reports, double interval_ms) {
  const auto over = std::ranges::find_if(
      reports, [&](const LoadReport& r) { return r.p99_ms > interval_ms || r.availability < 0.99; });
  return over == reports.end() ? std::nullopt : std::optional(over->clients);
}

std::string plot_svg(const std::vector<LoadReport>& reports, double interval_ms) {
  double most_ms = 10;
  for (const LoadReport& r : reports) most_ms = std::max(most_ms, r.p99_ms);
  const double few = reports.front().clients;
  const Axis x{few, std::max(2 * few, static_cast<double>(reports.back().clients)), kLeft, kWidth - kRight};
  const Axis y{1, std::pow(10, std::ceil(std::log10(most_ms))), kHeight - kBottom, kTop};
  std::string svg = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" font-family="sans-serif" font-size="12">)"
      R"(<rect width="{0}" height="{1}" fill="#fff"/>)",
      kWidth, kHeight);
  svg += "\n" + grid(x, y);
  for (const LoadReport& r : reports)
    svg += text(x.px(r.clients), kHeight - kBottom + 18, "middle", fmt::format("{}", r.clients));
  for (const Curve& c : kCurves) svg += curve(reports, c, x, y);
  if (const auto knee = knee_of(reports, interval_ms)) {
    svg += fmt::format(R"(<path d="M{:.1f} {:.1f}V{:.1f}" stroke="#888" stroke-dasharray="4"/>)", x.px(*knee),
                       y.to_px, y.from_px);
    svg += text(x.px(*knee), kTop - 8, "middle", "knee: p99 over an interval, or under 99 % available");
  }
  svg += text(kWidth / 2, kHeight - 12, "middle", "clients (hollow points: void)");
  svg += text(12, kTop - 8, "start", "latency, ms");
  return svg + "</svg>\n";
}

}  // namespace liloc::load
