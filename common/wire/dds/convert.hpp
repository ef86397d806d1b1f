#pragma once
// Private to common/wire: small conversions that every message needs.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.hpp"
#include "common/base/text.hpp"
#include "common/geometry/pose.hpp"

namespace liloc::wire {

/// Into a bounded IDL string, cut where it is too long: DDS writes an unterminated one without complaint.
template <std::size_t N>
void copy_text(char (&to)[N], std::string_view from) {
  const std::size_t length = std::min(from.size(), N - 1);
  std::memcpy(to, from.data(), length);
  std::memset(to + length, 0, N - length);
}

/// Without control characters: what comes from a stranger ends up in logs and on terminals.
template <std::size_t N>
std::string text_of(const char (&from)[N]) {
  return without_controls(std::string_view(from, strnlen(from, N)));
}

/// Lends a vector's memory to an outgoing sample; DDS reads it and never frees it.
template <class Sequence, class T>
void lend(Sequence& sequence, const std::vector<T>& from) {
  sequence._maximum = sequence._length = static_cast<std::uint32_t>(from.size());
  sequence._buffer = const_cast<T*>(from.data());
  sequence._release = false;
}

inline Status finite(double value, std::string_view what, double min, double max) {
  if (!std::isfinite(value) || value < min || value > max)
    return fail("{} is {}, must be {}..{}", what, value, min, max);
  return {};
}

}  // namespace liloc::wire
