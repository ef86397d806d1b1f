#pragma once
#include <chrono>

#include "common/base/line_limit.hpp"
#include "common/base/log.hpp"

namespace liloc::log {

/// A warning that a bad stream repeats: one in five seconds, and how many like it were held back before.
/// `limit` is of this line alone, and used by one thread at a time.
template <class... Args>
void limited(LineLimit& limit, fmt::format_string<Args...> text, Args&&... args) {
  if (const auto held = limit.pass(std::chrono::steady_clock::now()))
    warning("{}{}", fmt::format(text, std::forward<Args>(args)...), held_back(*held));
}

}  // namespace liloc::log
