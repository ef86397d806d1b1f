#include "proto-tests/load/report.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "proto-tests/load/plot.hpp"

namespace liloc::load {
namespace {

using testing::HasSubstr;
using testing::Not;

RequestRow row(Outcome outcome, double latency_ms = 10, double lag_ms = 0.1) {
  return {10, lag_ms, latency_ms, outcome, false, false};
}

TEST(LoadReport, EveryOutcomeIsCounted) {
  Outcomes outcomes;
  for (const Outcome o : {Outcome::unsent, Outcome::unanswered, Outcome::verified, Outcome::verified,
                          Outcome::provisional, Outcome::refused, Outcome::superseded})
    outcomes.requests.push_back(row(o));
  outcomes.requests[2].wrong = true;
  const LoadReport r = summarize(3, 20, outcomes);
  EXPECT_EQ(r.planned, 7U);
  EXPECT_EQ(r.sent, 6U);
  EXPECT_EQ(r.answered, 5U);
  EXPECT_EQ(r.unanswered, 1U);
  EXPECT_EQ(r.verified, 2U);
  EXPECT_EQ(r.provisional, 1U);
  EXPECT_EQ(r.refused, 1U);
  EXPECT_EQ(r.superseded, 1U);
  EXPECT_EQ(r.wrong_verified, 1U);
  EXPECT_EQ(r.max_ms, 4000) << "what was not answered counts with the client's timeout";
}

TEST(LoadReport, LatencyIsThatOfAllRequests) {
  Outcomes outcomes;
  for (int i = 1; i <= 1000; ++i) outcomes.requests.push_back(row(Outcome::verified, i));
  const LoadReport r = summarize(1, 20, outcomes);
  EXPECT_NEAR(r.p50_ms, 501, 1);
  EXPECT_NEAR(r.p95_ms, 951, 1);
  EXPECT_NEAR(r.p99_ms, 991, 1);
  EXPECT_NEAR(r.p999_ms, 1000, 1);
  EXPECT_EQ(r.max_ms, 1000);
}

TEST(LoadReport, AGeneratorThatIsLateVoidsTheRun) {
  Outcomes outcomes;
  for (int i = 0; i < 98; ++i) outcomes.requests.push_back(row(Outcome::verified));
  EXPECT_TRUE(summarize(1, 20, outcomes).valid);
  for (int i = 0; i < 3; ++i) outcomes.requests.push_back(row(Outcome::verified, 10, 6));
  const LoadReport late = summarize(1, 20, outcomes);
  EXPECT_FALSE(late.valid);
  EXPECT_THAT(late.why, HasSubstr("6.0 ms late"));
  EXPECT_THAT(to_table({late}), HasSubstr("VOID"));
}

TEST(LoadReport, AGeneratorThatHasNotJoinedInTimeVoidsTheRun) {
  Outcomes outcomes;
  for (int i = 0; i < 97; ++i) outcomes.requests.push_back(row(Outcome::verified));
  for (int i = 0; i < 3; ++i) outcomes.requests.push_back(row(Outcome::unsent, 0, 0.1));
  EXPECT_TRUE(summarize(1, 20, outcomes).valid) << "sent in time, but no server was in sight";
  for (int i = 0; i < 3; ++i) outcomes.requests.push_back(row(Outcome::unsent, 0, 4000));
  EXPECT_FALSE(summarize(1, 20, outcomes).valid);
}

TEST(LoadReport, ARunWithoutAServerIsVoid) {
  const LoadReport r = summarize(1, 20, {{row(Outcome::unsent)}, {}});
  EXPECT_FALSE(r.valid);
  EXPECT_THAT(r.why, HasSubstr("no server"));
}

TEST(LoadReport, DevicesThatLostTheirWayAreCountedApart) {
  Outcomes outcomes{{row(Outcome::verified)}, {}};
  for (const auto& [available_s, recovered_s] :
       {std::pair{9.0, -1.0}, {8.0, 3.0}, {3.0, std::numeric_limits<double>::infinity()}}) {
    DeviceRow& device = outcomes.devices.emplace_back();
    device.present_s = 10;
    device.available_s = available_s;
    device.recovered_s = recovered_s;
  }
  outcomes.requests.push_back(row(Outcome::verified, 900));
  outcomes.requests.back().of_lost = true;
  const LoadReport r = summarize(3, 10, outcomes);
  EXPECT_NEAR(r.availability, 20.0 / 30, 1e-9);
  EXPECT_EQ(r.lost, 2U);
  EXPECT_EQ(r.found_again, 1U);
  EXPECT_EQ(r.found_again_max_s, 3);
  EXPECT_EQ(r.tracked_p99_ms, 10);
  EXPECT_EQ(r.p99_ms, 900);
  EXPECT_THAT(to_table({r}), HasSubstr("1 of 2 that lost their odometry were found again"));
}

TEST(LoadReport, TheFileHoldsOneObjectOrAnArray) {
  LoadReport r = summarize(8, 20, {{row(Outcome::verified)}, {}});
  r.server_cpu_s = 4;
  const auto one = nlohmann::json::parse(to_json({r}));
  EXPECT_EQ(one.at("clients"), 8);
  EXPECT_EQ(one.at("requests").at("verified"), 1);
  EXPECT_EQ(one.at("requests").size(), 8U);
  EXPECT_EQ(one.at("latency_ms").size(), 5U);
  EXPECT_EQ(one.at("server").at("cpu_s"), 4);
  EXPECT_TRUE(one.at("server").at("rss_mb").is_null()) << "not of a server elsewhere";
  EXPECT_TRUE(one.at("valid"));
  for (const char* key : {"seconds", "wrong_verified", "availability", "generator", "why"})
    EXPECT_TRUE(one.contains(key));
  EXPECT_EQ(nlohmann::json::parse(to_json({r, r})).size(), 2U);
}

TEST(LoadPlot, TheKneeIsWhereLatencyOrAvailabilityGive) {
  std::vector<LoadReport> reports(3);
  for (std::size_t i = 0; i < 3; ++i) {
    reports[i].clients = 10 << i;
    reports[i].availability = 1;
    reports[i].p99_ms = 100;
  }
  EXPECT_FALSE(knee_of(reports, 800));
  EXPECT_THAT(plot_svg(reports, 800), Not(HasSubstr("knee")));
  reports[2].p99_ms = 900;
  EXPECT_EQ(knee_of(reports, 800), 40);
  reports[1].availability = 0.98;
  EXPECT_EQ(knee_of(reports, 800), 20);
  EXPECT_THAT(plot_svg(reports, 800), HasSubstr("knee"));
  EXPECT_THAT(plot_svg({reports[0]}, 800), Not(HasSubstr("nan"))) << "one run is a point";
}

}  // namespace
}  // namespace liloc::load
