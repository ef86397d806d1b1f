#pragma once
// How answers came out over the last ten minutes, and how long they took.
#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "common/protocol/spot.hpp"

namespace liloc::view {

constexpr std::chrono::seconds kColumn{5};  ///< of the chart; by hand
constexpr int kColumns = 120;               ///< ten minutes; by hand

struct ChartColumn {
  std::uint32_t verified = 0, provisional = 0, refused = 0;
  std::optional<double> median_ms, p95_ms;  ///< of all answers in it, within 10 %; empty where there are none
};

/// Not thread-safe. Its size does not grow with the answers.
class OutcomeChart {
 public:
  using Time = std::chrono::steady_clock::time_point;

  void add(Time at, SpotStatus status, double latency_ms);
  /// kColumns of them, the oldest first; the last one is not over yet.
  [[nodiscard]] std::vector<ChartColumn> columns(Time now) const;

 private:
  static constexpr std::size_t kBins = 64;  ///< four to a doubling, from 0.25 ms to 16 s
  struct Column {
    std::int64_t index = 0;  ///< since the clock's epoch, in kColumn
    std::array<std::uint32_t, 3> outcomes{};
    std::array<std::uint32_t, kBins> latencies{};
  };
  [[nodiscard]] static std::size_t bin_of(double latency_ms);
  [[nodiscard]] static double middle_ms(std::size_t bin);
  [[nodiscard]] static std::optional<double> quantile_ms(const Column& column, double q);

  std::deque<Column> columns_;  ///< by rising index, those with answers
};

}  // namespace liloc::view
