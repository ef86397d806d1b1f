#pragma once
#include <cstdint>
#include <deque>

#include "common/protocol/spot.hpp"

namespace liloc {

/// What was asked, so that a reply which nobody asked for counts for nothing. Stamps are the device's and can
/// hardly be guessed, unlike seq. A late answer still counts, for as long as kKept requests. Not thread-safe.
class OpenRequests {
 public:
  void sent(const SpotRequest& request) {
    asked_.push_back({request.seq, request.stamp_ns});
    if (asked_.size() > kKept) asked_.pop_front();
  }
  [[nodiscard]] bool answered_by(const SpotReply& reply) const {
    for (const Asked& asked : asked_)
      if (asked.seq == reply.seq) return asked.stamp_ns == reply.stamp_ns;
    return false;
  }

 private:
  // 13 s of the default's quickest searching; what is answered later is of little use, whatever the timeout.
  static constexpr std::size_t kKept = 64;
  struct Asked {
    std::uint64_t seq = 0;
    StampNs stamp_ns = 0;
  };
  std::deque<Asked> asked_;
};

}  // namespace liloc
