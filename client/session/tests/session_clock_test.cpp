#include "client/session/session_clock.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

using namespace std::chrono_literals;

constexpr StampNs kStart = 1'700'000'000'000'000'000;

/// A device whose clock runs ahead of the ceiling's, and a server a millisecond away.
class TwoClocks : public testing::Test {
 protected:
  [[nodiscard]] StampNs device_ns() const { return kStart + now_.time_since_epoch().count() + ahead_ns; }
  void exchange() {
    now_ += 100ms;
    clock.frame(device_ns(), now_);
    SpotRequest request;
    request.stamp_ns = device_ns();
    clock.stamp(request, now_);
    now_ += 1ms;
    SpotReply reply;
    reply.request_sent_ns = request.sent_ns;
    reply.server_received_ns = reply.server_sent_ns = device_ns() - ahead_ns;
    now_ += 1ms;
    jumped |= clock.learn(reply, now_);
    sent = request;
  }
  SessionClock::Time now_ = SessionClock::Time(10s);
  SessionClock clock;
  SpotRequest sent;
  bool jumped = false;
  StampNs ahead_ns = from_ms(400);
};

TEST_F(TwoClocks, RequestsComeToBeStampedByTheCeiling) {
  exchange();
  EXPECT_EQ(sent.sent_ns, sent.stamp_ns);  // it left as the frame came
  EXPECT_EQ(sent.ceiling_stamp_ns, 0);     // nothing is known yet
  for (int i = 0; i < 10; ++i) exchange();
  EXPECT_NEAR(to_ms(sent.stamp_ns - sent.ceiling_stamp_ns), 400, 0.01);
  ASSERT_TRUE(clock.offset());
  EXPECT_NEAR(to_ms(clock.offset()->offset_ns), 400, 0.01);
  EXPECT_FALSE(jumped);
}

TEST_F(TwoClocks, AClockThatWasSetIsLearnedAnew) {
  for (int i = 0; i < 10; ++i) exchange();
  now_ += 100ms;
  ahead_ns += from_ms(5000);
  EXPECT_TRUE(clock.frame(device_ns(), now_));
  EXPECT_FALSE(clock.offset());
  for (int i = 0; i < 10; ++i) exchange();
  EXPECT_NEAR(to_ms(clock.offset()->offset_ns), 5400, 0.01);
}

TEST_F(TwoClocks, NothingIsLearnedWithoutAFrame) {
  EXPECT_FALSE(clock.learn({}, now_));
  EXPECT_FALSE(clock.offset());
  SpotRequest request;
  clock.stamp(request, now_);
  EXPECT_EQ(request.sent_ns, 0);
}

TEST_F(TwoClocks, AfterItsClockWasSetBackTheDeviceIsTimedRightAtOnce) {
  for (int i = 0; i < 10; ++i) exchange();
  ahead_ns -= from_ms(10'000);
  clock.forget();
  EXPECT_FALSE(clock.offset());
  exchange();
  EXPECT_EQ(sent.sent_ns, sent.stamp_ns);
  for (int i = 0; i < 3; ++i) exchange();
  EXPECT_NEAR(to_ms(sent.stamp_ns - sent.ceiling_stamp_ns), -9600, 0.01);
  EXPECT_FALSE(jumped);
}

}  // namespace
}  // namespace liloc
