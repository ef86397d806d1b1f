#pragma once
#include <string>
#include <string_view>

namespace liloc {

/// What a stranger wrote, fit for one line of a log or terminal: each byte of a control character is shown as
/// '?', an end of line as a blank; UTF-8 stays as it was.
[[nodiscard]] std::string without_controls(std::string_view text);

}  // namespace liloc
