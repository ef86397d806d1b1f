#pragma once
#include <tl/expected.hpp>
#include <utility>

#include "common/base/result.hpp"

namespace liloc {

/// Why nothing was converted.
struct ConvertError {
  ConvertError(Error error) : message(std::move(error.message)) {}
  std::string message;
  bool unwritten = false;  ///< what the input became could not be written: the input is not at fault
};

template <class T>
using Conversion = tl::expected<T, ConvertError>;

[[nodiscard]] inline tl::unexpected<ConvertError> unwritten(Error error) {
  ConvertError made(std::move(error));
  made.unwritten = true;
  return tl::unexpected(std::move(made));
}

}  // namespace liloc
