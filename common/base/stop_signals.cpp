#include "common/base/stop_signals.hpp"

#include <algorithm>
#include <ctime>

namespace liloc {

StopSignals::StopSignals() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
}

int StopSignals::within(std::chrono::milliseconds time) const {
  const timespec at_most{time.count() / 1000, time.count() % 1000 * 1'000'000};
  return std::max(0, sigtimedwait(&signals_, nullptr, &at_most));
}

}  // namespace liloc
