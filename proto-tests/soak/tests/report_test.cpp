#include "proto-tests/soak/report.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace liloc::soak {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

SoakReport sound_report() {
  SoakReport report;
  report.seconds = 600;
  report.judged_from_s = 120;
  report.answered = 1000;
  report.processes.push_back({"server", 12, {200, 205, 160, 1}, {14, 14, 160, 0}, {30, 31, 160, 0}});
  return report;
}

TEST(SoakReport, NothingGrew) {
  SoakReport report = sound_report();
  judge(report);
  EXPECT_THAT(report.failures, IsEmpty());
  EXPECT_THAT(to_table(report), HasSubstr("nothing grew"));
  EXPECT_TRUE(nlohmann::json::parse(to_json(report)).at("passed"));
}

TEST(SoakReport, EachThingThatGrewIsNamed) {
  SoakReport report = sound_report();
  report.processes[0].memory_mb = {200, 213, 160, 90};
  report.processes.push_back({"resident0", 4, {30, 30, 160, 0}, {10, 13, 160, 30}, {20, 25, 160, 40}});
  judge(report);
  EXPECT_THAT(report.failures,
              ElementsAre("server: memory grew from 200.0 to 213.0 MB; 12.0 more are allowed",
                          "resident0: threads grew from 10.0 to 13.0; 2.0 more are allowed",
                          "resident0: descriptors grew from 20.0 to 25.0; 2.0 more are allowed"));
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_FALSE(json.at("passed"));
  EXPECT_EQ(json.at("why").size(), 3U);
  EXPECT_EQ(json.at("processes")[0].at("memory_mb").at("growth"), 13);
}

TEST(SoakReport, AShortRunSaysThatItDoesNotTellWhetherAnythingGrows) {
  SoakReport report = sound_report();
  report.processes[0].memory_mb = {200, 300, 5, 90};
  judge(report);
  EXPECT_THAT(report.failures, IsEmpty());
  EXPECT_FALSE(report.judged);
  EXPECT_THAT(to_table(report), HasSubstr("too short to judge"));
  EXPECT_THAT(to_table(report), Not(HasSubstr("nothing grew")));
  EXPECT_TRUE(nlohmann::json::parse(to_json(report)).at("passed").is_null());
  report.answered = 0;
  judge(report);
  EXPECT_THAT(report.failures, ElementsAre("server: it answered nobody")) << "that it works is judged";
  EXPECT_EQ(nlohmann::json::parse(to_json(report)).at("passed"), false);
}

TEST(SoakReport, ASiteThatNoLongerWorksFailsThoughNothingGrows) {
  SoakReport report = sound_report();
  std::vector<Visit> visits;
  for (double from_s = 130; from_s < 590; from_s += 10) {
    Visit& visit = visits.emplace_back();
    visit.from_s = from_s;
    visit.to_s = from_s + 9;
    if (from_s < 430) visit.located_after_s = 2;
  }
  add_visits(visits, report);
  EXPECT_GT(report.located_share, 0.6);
  EXPECT_EQ(report.last_located_share, 0);
  report.answered = 0;
  report.restarts = 5;
  report.silent_restarts = 1;
  report.log_kb_per_min = 100;
  judge(report);
  EXPECT_THAT(report.failures,
              ElementsAre("server: it answered nobody", "standby: 1 of 5 restarted servers answered nobody",
                          HasSubstr("visitors: 0 % of 15 long visits were located in the last third"),
                          "server: 100 kB of log a minute, over 20"));
}

TEST(SoakReport, ShortVisitsAndTheWarmUpAreNotHeldAgainstIt) {
  SoakReport report = sound_report();
  add_visits({{.from_s = 10, .to_s = 40}, {.from_s = 300, .to_s = 304}}, report);
  EXPECT_EQ(report.visits, 2U);
  EXPECT_EQ(report.long_visits, 0U);
  judge(report);
  EXPECT_THAT(report.failures, IsEmpty());
}

TEST(SoakReport, TablesOfCsvHaveARowASampleAndAVisit) {
  const Watched watched{"server", 12, {{1, 200.5}, {2, 201}}, {{1, 14}, {2, 14}}, {{1, 30}, {2, 31}}};
  EXPECT_EQ(samples_csv({watched}),
            "at_s,process,memory_mb,threads,descriptors\n1.0,server,200.50,14,30\n2.0,server,201.00,14,31\n");
  EXPECT_EQ(visits_csv({{1, 9, 2.5, 80, 9, 8, 7}, {1, 9, -1, 80, 9, 0, 0}}),
            "from_s,to_s,located_after_s,frames,requests,replies,verified\n1.00,9.00,2.50,80,9,8,7\n"
            "1.00,9.00,,80,9,0,0\n");
}

}  // namespace
}  // namespace liloc::soak
