#include "client/session/frame_budget.hpp"

#include <algorithm>
#include <ctime>
#include <vector>

#include "common/base/quantile.hpp"

namespace liloc {
namespace {

constexpr std::size_t kRecent = 31, kFewest = 5;  // frames: two seconds at 15 Hz; by hand
constexpr StampNs kLate = from_ms(500);  // of what is older by more the clock was set, as StampWatch has it
constexpr double kSlack = 0.9;           // frames do not come at even distances; by hand

}  // namespace

double FrameBudget::interval_ms() const {
  if (needed_ms_.size() < kFewest) return 0;
  return median(
      std::vector<double>(needed_ms_.begin(), needed_ms_.end()));  // one search by features is no trend
}

bool FrameBudget::admit(StampNs stamp_ns) {
  if (last_ns_ && stamp_ns > *last_ns_ && to_ms(stamp_ns - *last_ns_) < kSlack * interval_ms()) return false;
  if (!last_ns_ || stamp_ns > *last_ns_ || stamp_ns < *last_ns_ - kLate) last_ns_ = stamp_ns;
  return true;
}

void FrameBudget::spent(double wall_ms, double cpu_ms) {
  needed_ms_.push_back(std::max(wall_ms, cpu_ms / cpu_share_));
  if (needed_ms_.size() > kRecent) needed_ms_.pop_front();
}

double thread_cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

}  // namespace liloc
