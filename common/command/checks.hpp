#pragma once
// What an option's value must be, checked where it is given: the error has an excerpt of it and the range.
#include <CLI/CLI.hpp>
#include <concepts>
#include <string>
#include <string_view>
#include <vector>

namespace liloc::command {

/// A finite number in [low, high]. CLI11's own Range lets NaN pass.
[[nodiscard]] CLI::Validator number_within(double low, double high);
/// A whole number in [low, high].
[[nodiscard]] CLI::Validator whole_within(long long low, long long high);

/// For an option of either kind.
template <class T>
[[nodiscard]] CLI::Validator in_range(T low, T high) {
  if constexpr (std::integral<T>)
    return whole_within(static_cast<long long>(low), static_cast<long long>(high));
  else
    return number_within(low, high);
}

/// Any seed.
[[nodiscard]] CLI::Validator any_seed();
/// Any finite number.
[[nodiscard]] CLI::Validator finite();
/// One of these words.
[[nodiscard]] CLI::Validator one_of(std::vector<std::string> words);
/// An id of a device, LiDAR or server.
[[nodiscard]] CLI::Validator an_id();

/// How close two names are: the letters to change, add or drop.
[[nodiscard]] std::size_t letters_between(std::string_view a, std::string_view b);

}  // namespace liloc::command
