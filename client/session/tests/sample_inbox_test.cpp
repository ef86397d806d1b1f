#include "client/session/sample_inbox.hpp"

#include <gtest/gtest.h>

#include <future>

namespace liloc {
namespace {

using namespace std::chrono_literals;

OdometrySample odometry_at(StampNs stamp_ns) {
  OdometrySample sample;
  sample.stamp_ns = stamp_ns;
  return sample;
}

TEST(SampleInbox, GivesEachSampleOnceInTheirOrder) {
  SampleInbox inbox;
  for (StampNs stamp = 1; stamp <= 3; ++stamp) inbox.add(ImuSample{stamp, {}, {}});
  inbox.add(odometry_at(2));
  const auto samples = inbox.take();
  ASSERT_EQ(samples.imu.size(), 3U);
  EXPECT_EQ(samples.imu.front().stamp_ns, 1);
  EXPECT_EQ(samples.odometry.size(), 1U);
  EXPECT_TRUE(inbox.take().imu.empty());
}

TEST(SampleInbox, KeepsTheNewestWhileNobodyTakesThem) {
  SampleInbox inbox;
  for (StampNs stamp = 1; stamp <= 10'000; ++stamp) inbox.add(ImuSample{stamp, {}, {}});
  const auto samples = inbox.take();
  EXPECT_EQ(samples.imu.size(), 4000U);
  EXPECT_EQ(samples.imu.back().stamp_ns, 10'000);
}

TEST(SampleInbox, WaitsForOdometryOfTheStamp) {
  SampleInbox inbox;
  inbox.await_odometry(5, 1h);  // none ever came: nothing to wait for
  inbox.add(odometry_at(5));
  inbox.await_odometry(5, 1h);
  auto waited = std::async(std::launch::async, [&] { inbox.await_odometry(7, 1h); });
  inbox.add(odometry_at(6));
  EXPECT_EQ(waited.wait_for(20ms), std::future_status::timeout);
  inbox.add(odometry_at(7));
  EXPECT_EQ(waited.wait_for(20s), std::future_status::ready);
}

TEST(SampleInbox, WaitsOnAfterAStampFarAhead) {
  SampleInbox inbox;
  inbox.add(odometry_at(from_seconds(3600)));
  inbox.add(odometry_at(6));
  auto waited = std::async(std::launch::async, [&] { inbox.await_odometry(7, 1h); });
  EXPECT_EQ(waited.wait_for(20ms), std::future_status::timeout);
  inbox.add(odometry_at(7));
  EXPECT_EQ(waited.wait_for(20s), std::future_status::ready);
}

TEST(SampleInbox, WaitsNoLongerThanToldNorAfterClose) {
  SampleInbox inbox;
  inbox.add(odometry_at(1));
  inbox.await_odometry(2, 1ms);
  auto waited = std::async(std::launch::async, [&] { inbox.await_odometry(2, 1h); });
  inbox.close();
  EXPECT_EQ(waited.wait_for(20s), std::future_status::ready);
  inbox.await_odometry(2, 1h);
}

}  // namespace
}  // namespace liloc
