#include "server/view/outcome_chart.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace liloc::view {
namespace {

constexpr double kFirst_ms = 0.25, kBinsADoubling = 4;  // edges of the bins of latency; by hand

std::int64_t index_of(OutcomeChart::Time at) {
  return at.time_since_epoch() / std::chrono::nanoseconds(kColumn);
}

}  // namespace

std::size_t OutcomeChart::bin_of(double latency_ms) {
  if (!(latency_ms > kFirst_ms)) return 0;
  const double bin = kBinsADoubling * std::log2(latency_ms / kFirst_ms);
  return static_cast<std::size_t>(std::min(bin, static_cast<double>(kBins - 1)));
}

double OutcomeChart::middle_ms(std::size_t bin) {
  return kFirst_ms * std::exp2((static_cast<double>(bin) + 0.5) / kBinsADoubling);
}

std::optional<double> OutcomeChart::quantile_ms(const Column& column, double q) {
  const auto& counts = column.latencies;
  const auto all = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  if (all == 0) return std::nullopt;
  const auto rank = static_cast<std::uint64_t>(q * static_cast<double>(all));
  std::uint64_t below = 0;
  std::size_t bin = 0;
  while (bin + 1 < kBins && (below += counts.at(bin)) <= rank) ++bin;
  return middle_ms(bin);
}

void OutcomeChart::add(Time at, SpotStatus status, double latency_ms) {
  const std::int64_t index = index_of(at);
  if (columns_.empty() || columns_.back().index < index) columns_.push_back({index, {}, {}});
  while (columns_.front().index <= index - kColumns) columns_.pop_front();
  Column& column = columns_.back();  // what comes a moment late counts for now
  ++column.outcomes.at(status == SpotStatus::verified ? 0 : status == SpotStatus::provisional ? 1 : 2);
  ++column.latencies.at(bin_of(latency_ms));
}

std::vector<ChartColumn> OutcomeChart::columns(Time now) const {
  std::vector<ChartColumn> told(kColumns);
  const std::int64_t first = index_of(now) - kColumns + 1;
  for (const Column& column : columns_)
    if (column.index >= first && column.index < first + kColumns)
      told.at(static_cast<std::size_t>(column.index - first)) = {column.outcomes[0], column.outcomes[1],
                                                                 column.outcomes[2], quantile_ms(column, 0.5),
                                                                 quantile_ms(column, 0.95)};
  return told;
}

}  // namespace liloc::view
