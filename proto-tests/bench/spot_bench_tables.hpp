#pragma once
// What `liloc_spot_bench` prints of its rows.
#include "proto-tests/bench/spot_bench_row.hpp"

namespace liloc::bench {

/// The value below which `share` of them lie; 0 of none.
[[nodiscard]] double percentile(std::vector<double> values, double share);

/// Success at both bounds, verified and wrong answers by tenths of true overlap; latencies.
void print_success(const std::vector<Row>& rows, bool cold);
/// The same by kind of site, for overlap over 0.3.
void print_by_site(const std::vector<Row>& rows);
/// One method's rows on the spots that all methods were asked for.
struct Method {
  std::string name;
  std::vector<Row> rows;
};
/// The methods side by side by overlap; latencies.
void print_methods(const std::vector<Method>& methods);
/// Whether the covariances of verified answers are what their errors are.
void print_consistency(const std::vector<Row>& rows);

/// Of squared errors over their covariances, six degrees of freedom each.
struct Consistency {
  std::size_t count = 0;
  double median = 0, mean = 0;  ///< 5.35 and 6 for an honest covariance; the mean of values cut at 100
  double inside = 0;            ///< share within the 95 % bounds of chi-squared ...
  double not_beyond = 0;        ///< ... and not beyond the upper one
};
[[nodiscard]] Consistency consistency_of(const std::vector<Row>& rows);

}  // namespace liloc::bench
