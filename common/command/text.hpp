#pragma once
// What strangers wrote, made fit for one line of a terminal or a log.
#include <string>
#include <string_view>

namespace liloc::command {

/// The beginning of `text`, at most 40 characters of it; what is not printable ASCII is shown as '?'.
[[nodiscard]] std::string excerpt(std::string_view text);

/// One line without control characters, UTF-8 as it was; the middle of a very long one is left out.
[[nodiscard]] std::string one_line(std::string_view text);

}  // namespace liloc::command
