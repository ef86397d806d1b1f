#include "client/session/open_requests.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

SpotRequest request(std::uint64_t seq) {
  SpotRequest r;
  r.seq = seq;
  r.stamp_ns = 1000 + static_cast<StampNs>(seq);
  return r;
}

SpotReply reply(std::uint64_t seq, StampNs stamp_ns) {
  SpotReply r;
  r.seq = seq;
  r.stamp_ns = stamp_ns;
  return r;
}

TEST(OpenRequests, NeedSeqAndStampOfARequestThatWasSent) {
  OpenRequests open;
  EXPECT_FALSE(open.answered_by(reply(1, 1001)));
  open.sent(request(1));
  open.sent(request(2));
  EXPECT_TRUE(open.answered_by(reply(1, 1001)));
  EXPECT_TRUE(open.answered_by(reply(1, 1001))) << "the standby answers as well";
  EXPECT_TRUE(open.answered_by(reply(2, 1002)));
  EXPECT_FALSE(open.answered_by(reply(2, 1001)));
  EXPECT_FALSE(open.answered_by(reply(3, 1003)));
}

TEST(OpenRequests, LateAnswersCountForALimitedTime) {
  OpenRequests open;
  for (std::uint64_t seq = 1; seq <= 65; ++seq) open.sent(request(seq));
  EXPECT_FALSE(open.answered_by(reply(1, 1001)));
  EXPECT_TRUE(open.answered_by(reply(2, 1002)));
}

}  // namespace
}  // namespace liloc
