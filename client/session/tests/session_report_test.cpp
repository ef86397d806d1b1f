#include "client/session/session_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/log.hpp"

namespace liloc {
namespace {

FrameResult frame_at(double second, bool located = false, double latency_ms = 1) {
  FrameResult frame;
  frame.stamp_ns = from_seconds(second);
  frame.latency_ms = latency_ms;
  if (located) frame.T_map_sensor = Pose::Identity();
  return frame;
}

TEST(SessionReport, CountsTheTimeWithAPoseAndNoPauses) {
  SessionReport report("robot1");
  report.frame(frame_at(1, true), Tracking::tracking, "");
  report.frame(frame_at(1.5, true), Tracking::tracking, "");
  report.frame(frame_at(2, false), Tracking::searching, "");
  report.frame(frame_at(60, true), Tracking::tracking, "");  // after a pause of a minute
  EXPECT_DOUBLE_EQ(report.stats().localized_s, 0.5 + 1);
  EXPECT_EQ(report.newest()->stamp_ns, from_seconds(60));
}

TEST(SessionReport, TellsTheUsualAndTheWorstTimeOfTheRecentFrames) {
  SessionReport report("robot1");
  EXPECT_EQ(report.stats().frame_ms_median, 0);
  for (int i = 0; i < 1000; ++i) report.frame(frame_at(i, false, i < 400 ? 1000 : i % 10), {}, "");
  EXPECT_NEAR(report.stats().frame_ms_median, 5, 1);
  EXPECT_EQ(report.stats().frame_ms_p99, 9);
}

TEST(SessionReport, LogsWhatChangesOnce) {
  std::vector<std::string> lines;
  log::set_sink([&](log::Level, std::string_view line) { lines.emplace_back(line); });
  SessionReport report("robot1");
  for (int i = 0; i < 3; ++i)
    report.frame(frame_at(i), Tracking::tracking, "too wide by " + std::to_string(i) + ".5 mm");
  report.frame(frame_at(4), Tracking::coasting, "too far");
  report.frame(frame_at(5), Tracking::coasting, "");
  log::set_sink({});
  EXPECT_THAT(lines, testing::ElementsAre("robot1: too wide by 0.5 mm", "robot1: tracking", "robot1: too far",
                                          "robot1: coasting: located by the device alone"));
  EXPECT_EQ(report.stats().problem, "");
}

TEST(SessionReport, WhoHearsALineMayAsk) {
  SessionReport report("robot1");
  std::vector<std::uint64_t> asked;
  log::set_sink([&](log::Level, std::string_view) { asked.push_back(report.stats().frames_refused); });
  report.frame(frame_at(1), Tracking::tracking, "too wide");
  report.frame_refused("wrong");
  report.samples_refused(&SessionStats::imu_refused, 1, "wrong");
  report.reply_dropped("wrong");
  report.trace_failed("full");
  log::set_sink({});
  EXPECT_THAT(asked, testing::ElementsAre(0U, 0U, 1U, 1U, 1U, 1U));
}

TEST(SessionReport, IsLostWithoutFramesAndComesBackWithThem) {
  using namespace std::chrono_literals;
  SessionReport report("robot1");
  const auto later = std::chrono::steady_clock::now() + 5s;
  EXPECT_EQ(report.tracking(later), Tracking::searching);
  EXPECT_EQ(report.stats(later).problem, "");
  report.frame(frame_at(1, true), Tracking::tracking, "");
  EXPECT_EQ(report.tracking(), Tracking::tracking);
  EXPECT_EQ(report.tracking(later), Tracking::lost);
  EXPECT_THAT(report.stats(later).problem, testing::HasSubstr("no depth frames for"));
  report.frame_refused("wrong");
  report.frame_refused("wrong");
  EXPECT_EQ(report.tracking(), Tracking::tracking);
  report.frame_refused("wrong");
  EXPECT_EQ(report.tracking(), Tracking::lost);
  EXPECT_EQ(report.stats().problem, "wrong");
  report.frame(frame_at(2, true), Tracking::tracking, "");
  EXPECT_EQ(report.tracking(), Tracking::tracking);
  EXPECT_EQ(report.stats().problem, "");
  report.ended();
  EXPECT_EQ(report.tracking(later), Tracking::tracking);  // nothing more is to come
}

TEST(SessionReport, TimeRunsNotBackwards) {
  SessionReport report("robot1");
  for (const double second : {100.0, 100.5, 90.0, 90.5})
    report.frame(frame_at(second, true), Tracking::tracking, "");
  EXPECT_DOUBLE_EQ(report.stats().localized_s, 1);
}

TEST(SessionReport, CountsByWhatAnAnswerSays) {
  SessionReport report("robot1");
  SpotReply reply;
  for (const SpotStatus status : {SpotStatus::verified, SpotStatus::provisional, SpotStatus::refused}) {
    reply.status = status;
    report.reply(reply);
  }
  report.count(&SessionStats::requests_unanswered, 4);
  EXPECT_EQ(report.stats().replies, 3U);
  EXPECT_EQ(report.stats().replies_verified, 1U);
  EXPECT_EQ(report.stats().replies_refused, 1U);
  EXPECT_EQ(report.stats().requests_unanswered, 4U);
}

}  // namespace
}  // namespace liloc
