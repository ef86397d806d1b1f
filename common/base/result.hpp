#pragma once
// How trouble is reported: bad input is an Error, a weak fit is a graded result, a bug is an assertion.
#include <fmt/format.h>

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace liloc {

/// One line that names the file or field, the value and the remedy.
struct Error {
  std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;
using Status = tl::expected<void, Error>;

/// `return fail("{}: width is {}, must be 1..8192", path, width);`
template <class... Args>
[[nodiscard]] tl::unexpected<Error> fail(fmt::format_string<Args...> text, Args&&... args) {
  return tl::unexpected(Error{fmt::format(text, std::forward<Args>(args)...)});
}

}  // namespace liloc
