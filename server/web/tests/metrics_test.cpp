#include "server/web/metrics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace liloc::web {
namespace {

using testing::HasSubstr;
using testing::Not;

ServerFacts busy() {
  ServerFacts facts;
  facts.server_id = "edge1";
  facts.version = "0.1.0";
  facts.uptime_s = 5;
  facts.clients = 4;
  facts.service.queued = 3;
  facts.service.clients_verified = 2;
  facts.service.clients_refused = 1;
  facts.samples_lost = 11;
  facts.lidars.push_back({{"ceiling0", wire::LidarState::ok, 7.5, 100, 2, "", 0.75, 2.4, 2.4, 37, true}, 0.25});
  facts.lidars.push_back({{"ceiling1", wire::LidarState::waiting, 0, 0, 0, ""}, std::nullopt});
  return facts;
}

TEST(Metrics, TellWhatTheServerIsNow) {
  const std::string text = Metrics().text(busy());
  for (const char* line :
       {"liloc_server_info{server_id=\"edge1\",version=\"0.1.0\"} 1", "liloc_queue_depth 3",
        "liloc_clients{state=\"verified\"} 2", "liloc_clients{state=\"none\"} 1",
        "liloc_lidar_up{lidar=\"ceiling0\"} 1", "liloc_lidar_up{lidar=\"ceiling1\"} 0",
        "liloc_lidar_rate_hz{lidar=\"ceiling0\"} 7.5", "liloc_lidar_valid_share{lidar=\"ceiling0\"} 0.75",
        "liloc_lidar_clock_offset_seconds{lidar=\"ceiling0\"} 37",
        "liloc_lidar_clock_corrected{lidar=\"ceiling0\"} 1", "liloc_lidar_dropped_total{lidar=\"ceiling0\"} 2",
        "liloc_gpc_age_seconds 0.25", "liloc_dds_samples_lost_total 11",
        "# TYPE liloc_lidar_frames_total counter"})
    EXPECT_THAT(text, HasSubstr(line));
  EXPECT_THAT(text, Not(HasSubstr("liloc_lidar_age_seconds{lidar=\"ceiling1\"}")));  // it has sent nothing
  EXPECT_THAT(text, Not(HasSubstr("liloc_lidar_clock_offset_seconds{lidar=\"ceiling1\"}")));
  EXPECT_THAT(text, HasSubstr("process_resident_memory_bytes "));
}

TEST(Metrics, CountAnswersByStatusAndReasonAndTimesByStage) {
  Metrics metrics;
  SpotReply reply;
  reply.client_id = "robot1";
  reply.reason = Reason::rate_limit;
  for (int i = 0; i < 3; ++i) metrics.answered(reply);
  metrics.staged(Stage::wait, 0.004);
  metrics.staged(Stage::work, 0.03);
  metrics.staged(Stage::work, 60);
  const std::string text = metrics.text(busy());
  EXPECT_THAT(text, HasSubstr("liloc_requests_total{reason=\"rate_limit\",status=\"refused\"} 3"));
  EXPECT_THAT(text, HasSubstr("liloc_requests_total{reason=\"confirmed\",status=\"verified\"} 0"));
  EXPECT_THAT(text, HasSubstr("liloc_request_stage_seconds_bucket{stage=\"wait\",le=\"0.005\"} 1"));
  EXPECT_THAT(text, HasSubstr("liloc_request_stage_seconds_count{stage=\"work\"} 2"));
  EXPECT_THAT(text, HasSubstr("liloc_request_stage_seconds_count{stage=\"hold\"} 0"));
  EXPECT_THAT(text, Not(HasSubstr("robot1")));
}

TEST(Metrics, AServerThatHasSeenNothingSaysNoAgeOfItsCloud) {
  EXPECT_THAT(Metrics().text({}), Not(HasSubstr("liloc_gpc_age_seconds")));
}

TEST(ProcessFacts, AreThoseOfThisProcess) {
  const ProcessFacts facts = process_facts();
  EXPECT_GT(facts.resident_bytes, 1e6);
  EXPECT_GE(facts.threads, 1);
  EXPECT_GE(facts.open_files, 3);
}

}  // namespace
}  // namespace liloc::web
