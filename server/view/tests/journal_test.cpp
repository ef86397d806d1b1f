#include "server/view/journal.hpp"

#include <gtest/gtest.h>

namespace liloc::view {
namespace {

using namespace std::chrono_literals;

const Journal::Time kStart = std::chrono::steady_clock::now();

SpotRequest request(const std::string& id, std::uint64_t seq, double x_odom_m = 0) {
  SpotRequest r;
  r.client_id = id;
  r.seq = seq;
  r.T_odom_sensor.translation().x() = x_odom_m;
  r.lpc.bytes = {1, 2, 3};
  return r;
}

SpotReply verified_at(const SpotRequest& r, double x_map_m) {
  SpotReply reply = refusal(r, Reason::confirmed, "");
  reply.status = SpotStatus::verified;
  reply.gpc_stamp_ns = 1;
  reply.confidence = 0.9999;
  reply.T_map_sensor = Pose::Identity();
  reply.T_map_sensor->translation().x() = x_map_m;
  reply.T_map_odom = *reply.T_map_sensor * r.T_odom_sensor.inverse();
  return reply;
}

void answer(Journal& journal, const SpotRequest& r, const SpotReply& reply, Journal::Time at = kStart) {
  journal.located(r, reply);
  journal.answered(reply, at);
}

TEST(Journal, ADeviceKeepsItsLastPoseAndItsTrail) {
  Journal journal;
  for (std::uint64_t seq = 1; seq <= 3; ++seq) {
    const auto r = request("a", seq);
    answer(journal, r, verified_at(r, static_cast<double>(seq)));
  }
  const auto lost = request("a", 4);
  answer(journal, lost, refusal(lost, Reason::not_found, "nothing fits"));
  const auto devices = journal.devices(kStart);
  ASSERT_EQ(devices.size(), 1U);
  const DeviceState& device = *devices[0];
  EXPECT_EQ(device.last.reason, Reason::not_found);
  EXPECT_EQ(device.T_map_sensor->translation().x(), 3);
  ASSERT_EQ(device.trail_map.size(), 3U);
  EXPECT_EQ(device.trail_map.front().x(), 1);
  EXPECT_EQ(device.answers, 4U);
  EXPECT_EQ(device.scan_seq, 4U);
}

TEST(Journal, AnUnlocatedCloudLiesWhereOdometryCarriedTheLastVerifiedPose) {
  Journal journal;
  const auto before = request("a", 1, 10);
  answer(journal, before, verified_at(before, 2));
  EXPECT_EQ(journal.scan_of("a"), nullptr) << "verified: nothing is to be explained";
  auto lost = request("a", 2, 10.5);
  answer(journal, lost, refusal(lost, Reason::not_found, ""));
  const auto scan = journal.scan_of("a");
  ASSERT_TRUE(scan && scan->T_map_sensor);
  EXPECT_NEAR(scan->T_map_sensor->translation().x(), 2.5, 1e-12);
  EXPECT_EQ(scan->seq, 2U);
  EXPECT_EQ(scan->cloud_sensor.bytes.size(), 3U);
  lost.odom_segment = 1;  // odometry broke: it says nothing about this one
  answer(journal, lost, refusal(lost, Reason::not_found, ""));
  EXPECT_FALSE(journal.scan_of("a")->T_map_sensor);
}

TEST(Journal, AGuessOfTheAnswerComesFirst) {
  Journal journal;
  const auto r = request("a", 1);
  auto reply = verified_at(r, 7);
  reply.status = SpotStatus::provisional;
  reply.T_map_odom.reset();
  answer(journal, r, reply);
  EXPECT_EQ(journal.scan_of("a")->T_map_sensor->translation().x(), 7);
  EXPECT_TRUE(journal.devices(kStart)[0]->trail_map.empty()) << "only verified places make a trail";
}

TEST(Journal, HeardLongestAgoIsForgottenFirst) {
  Journal journal;
  for (std::size_t i = 0; i < kDevicesKept + 10; ++i) {
    const auto r = request("d" + std::to_string(i), 1);
    answer(journal, r, refusal(r, Reason::not_found, ""), kStart + std::chrono::milliseconds(i));
  }
  const auto devices = journal.devices(kStart + 1s);
  EXPECT_EQ(devices.size(), kDevicesKept);
  EXPECT_EQ(std::ranges::count_if(devices, [](const auto& d) { return d->last.client_id == "d0"; }), 0);
  std::size_t scans = 0;
  for (const auto& device : devices) scans += journal.scan_of(device->last.client_id) != nullptr ? 1 : 0;
  EXPECT_EQ(scans, kScansKept);
}

TEST(Journal, TrailsAndCloudsAreBounded) {
  Journal journal;
  for (std::uint64_t seq = 1; seq <= 3 * kTrailKept; ++seq) {
    const auto r = request("a", seq);
    answer(journal, r, verified_at(r, static_cast<double>(seq)));
  }
  const auto trail = journal.devices(kStart)[0]->trail_map;
  EXPECT_EQ(trail.size(), kTrailKept);
  EXPECT_EQ(trail.back().x(), 3 * kTrailKept);
  auto huge = request("a", 1000);
  huge.lpc.bytes.resize(kScanBytes + 1);
  answer(journal, huge, refusal(huge, Reason::not_found, ""));
  EXPECT_EQ(journal.scan_of("a"), nullptr);
}

TEST(Journal, TheGoneAndTheForgottenAreNotTold) {
  Journal journal;
  const auto r = request("a", 1);
  answer(journal, r, verified_at(r, 1));
  EXPECT_EQ(journal.devices(kStart + 59s).size(), 1U);
  EXPECT_TRUE(journal.devices(kStart + 60s).empty());
  journal.forget("a");
  EXPECT_TRUE(journal.devices(kStart).empty());
}

TEST(Journal, WhenAllAreForgottenTheChartStays) {
  Journal journal;
  for (const char* id : {"a", "b"}) {
    const auto r = request(id, 1);
    answer(journal, r, refusal(r, Reason::not_found, ""));
  }
  journal.forget_all();
  EXPECT_TRUE(journal.devices(kStart).empty());
  EXPECT_EQ(journal.scan_of("a"), nullptr);
  EXPECT_EQ(journal.columns(kStart).back().refused, 2U);
}

TEST(Journal, EveryAnswerCountsInTheChart) {
  Journal journal;
  journal.answered(refusal(request("a", 1), Reason::rate_limit, ""), kStart);
  EXPECT_EQ(journal.columns(kStart).back().refused, 1U);
}

}  // namespace
}  // namespace liloc::view
