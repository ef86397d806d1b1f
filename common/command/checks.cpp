#include "common/command/checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/base/ids.hpp"
#include "common/command/text.hpp"

namespace liloc::command {
namespace {

template <class T>
bool parse(std::string_view text, T& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

template <class T>
CLI::Validator within(T low, T high, const char* kind) {
  return CLI::Validator(
      [=](std::string& given) {
        T value{};
        if (parse(given, value) && value >= low && value <= high) return std::string();  // NaN is in no range
        return fmt::format("is '{}'; give a {} in {}..{}", excerpt(given), kind, low, high);
      },
      fmt::format("{}..{}", low, high));
}

}  // namespace

CLI::Validator number_within(double low, double high) {
  return within(low, high, "number");
}

CLI::Validator whole_within(long long low, long long high) {
  return within(low, high, "whole number");
}

CLI::Validator any_seed() {
  return CLI::Validator(
      [](std::string& given) {
        std::uint64_t value = 0;
        if (parse(given, value)) return std::string();
        return fmt::format("is '{}'; give a whole number from 0", excerpt(given));
      },
      "0..");
}

CLI::Validator finite() {
  return CLI::Validator(
      [](std::string& given) {
        double value = 0;
        if (parse(given, value) && std::isfinite(value)) return std::string();
        return fmt::format("is '{}'; give a finite number", excerpt(given));
      },
      "");
}

CLI::Validator one_of(std::vector<std::string> words) {
  return CLI::Validator(
      [words = std::move(words)](std::string& given) {
        if (std::ranges::find(words, given) != words.end()) return std::string();
        return fmt::format("is '{}'; give one of {}", excerpt(given), fmt::join(words, ", "));
      },
      "");
}

CLI::Validator an_id() {
  return CLI::Validator(
      [](std::string& given) {
        if (valid_id(given, "id")) return std::string();
        return fmt::format("is '{}'; give 1 to 63 of A-Z a-z 0-9 _ -", excerpt(given));
      },
      "");
}

std::size_t letters_between(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (const char letter : a) {
    std::size_t corner = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = corner + (letter == b[j] ? 0 : 1);
      corner = row[j + 1];
      row[j + 1] = std::min({changed, row[j + 1] + 1, row[j] + 1});
    }
  }
  return row.back();
}

}  // namespace liloc::command
