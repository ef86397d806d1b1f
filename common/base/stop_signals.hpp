#pragma once
#include <chrono>
#include <csignal>

namespace liloc {

/// SIGINT and SIGTERM as an event to wait for: blocked in every thread, since a handler could do next to
/// nothing. To be made before the program's first thread, which inherits the mask.
class StopSignals {
 public:
  StopSignals();
  /// Which of them came within the time; 0: none.
  [[nodiscard]] int within(std::chrono::milliseconds time) const;

 private:
  sigset_t signals_{};
};

}  // namespace liloc
