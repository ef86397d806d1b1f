#include "common/base/stamp_clock.hpp"

#include <algorithm>

namespace liloc {
namespace {

using namespace std::chrono_literals;

// The newest stamps count; after a silence they begin anew. By hand, as all here.
constexpr auto kWindow = 10s, kSilence = 3s;
constexpr std::size_t kMost = 256;       // memory bound
constexpr StampNs kJump = from_ms(250);  // no delay of a frame changes by more
constexpr int kLateOnes = 5;             // in a row: it is not a busy moment, the clock was set back

StampNs steady_ns(StampClock::Time time) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(time.time_since_epoch()).count();
}

}  // namespace

StampNs StampClock::best() const {
  return std::max_element(recent_.begin(), recent_.end(),
                          [](const Lead& a, const Lead& b) { return a.lead_ns < b.lead_ns; })
      ->lead_ns;
}

bool StampClock::add(StampNs stamp_ns, Time arrived) {
  const Lead lead{arrived, stamp_ns - steady_ns(arrived)};
  bool set = false;
  if (!recent_.empty()) {
    const StampNs ahead = lead.lead_ns - best();
    late_ = ahead < -kJump ? late_ + 1 : 0;
    set = ahead > kJump || late_ >= kLateOnes;  // no stamp comes before it was made
  }
  if (set) {
    recent_.clear();
    late_ = 0;
  }
  recent_.push_back(lead);
  while (recent_.size() > kMost || arrived - recent_.front().arrived > kWindow) recent_.pop_front();
  return set;
}

std::optional<StampNs> StampClock::now(Time at) const {
  if (recent_.empty() || at - recent_.back().arrived > kSilence) return std::nullopt;
  return steady_ns(at) + best();
}

}  // namespace liloc
