#pragma once
// A process as Linux shows it.
#include <sys/types.h>

#include "common/base/result.hpp"

namespace liloc::soak {

struct ProcessFigures {
  double memory_mb = 0;  ///< its own: written to and shared with nobody, swapped out or not
  int threads = 0, descriptors = 0;
};

/// Error: it has ended, or is another user's.
[[nodiscard]] Result<ProcessFigures> figures_of(pid_t pid);

}  // namespace liloc::soak
