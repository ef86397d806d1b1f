#pragma once
#include <algorithm>
#include <vector>

namespace liloc {

/// The value that a share `q` (0..1) of the values lie below; of an even number the upper median. No
/// interpolation: it is one of the values. There must be at least one.
template <class T>
[[nodiscard]] T quantile(std::vector<T> values, double q) {
  const auto rank = static_cast<std::size_t>(q * static_cast<double>(values.size()));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::min(rank, values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

template <class T>
[[nodiscard]] T median(std::vector<T> values) {
  return quantile(std::move(values), 0.5);
}

}  // namespace liloc
