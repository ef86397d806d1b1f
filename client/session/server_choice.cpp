#include "client/session/server_choice.hpp"

#include <algorithm>

namespace liloc {

bool ServerChoice::takes(const SpotReply& reply) {
  const bool verified = reply.verified();
  if (reply.server_id != followed_ && answered_seq_ > 0) {
    const std::uint64_t seq = verified ? verified_seq_ : answered_seq_;  // what the followed one has to match
    if (reply.seq <= seq + 1) return false;
  }
  followed_ = reply.server_id;
  answered_seq_ = std::max(answered_seq_, reply.seq);
  if (verified) verified_seq_ = std::max(verified_seq_, reply.seq);
  return true;
}

}  // namespace liloc
