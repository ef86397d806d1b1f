#include "proto-tests/faults/verdict.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace liloc::faults {
namespace {

using testing::HasSubstr;

/// A device that asks once a second for ten seconds, and is not answered from second 4 to 7.
Performed performed() {
  Performed p;
  for (int s = 1; s < 10; ++s)
    if (s < 4 || s > 7) p.story.replies.push_back({s + 0.1, 1.0 * s, s > 1, false});
  for (int s = 0; s < 10; ++s) p.story.frames.push_back({1.0 * s, s > 2, s == 7, s == 6 ? 0.2 : 0.01, 0.5});
  p.story.requests = 9;
  p.story.unanswered = 4;
  p.times = {3.5, 6.5};
  p.frames = {75, 25};
  return p;
}

Scenario ten_seconds() {
  Scenario scenario;
  scenario.name = "silence";
  scenario.seconds = 10;
  return scenario;
}

TEST(Verdict, CountsFromTheFirstVerifiedAnswer) {
  const Verdict verdict = judge(ten_seconds(), performed());
  EXPECT_EQ(verdict.replies, 5U);
  EXPECT_EQ(verdict.verified, 4U);
  EXPECT_EQ(verdict.unanswered, 4U);
  EXPECT_DOUBLE_EQ(verdict.first_s.value(), 2.1);
  EXPECT_NEAR(verdict.gap_s.value(), 5, 1e-9);  // from 3.1 to 8.1
  EXPECT_EQ(verdict.frames, 7U);
  EXPECT_EQ(verdict.located, 7U);
  EXPECT_EQ(verdict.lost, 1U);
  EXPECT_DOUBLE_EQ(verdict.worst_m, 0.2);
  EXPECT_DOUBLE_EQ(verdict.frames_lost, 0.25);
}

TEST(Verdict, RecoveryIsTheFirstVerifiedAnswerAboutAFrameSinceTheTroubleWasOver) {
  Performed p = performed();
  EXPECT_NEAR(judge(ten_seconds(), p).recovery_s.value(), 1.6, 1e-9);
  EXPECT_TRUE(judge(ten_seconds(), p).good());
  p.story.replies.insert(p.story.replies.begin() + 3, {6.6, 6.0, true, false});  // asked before
  EXPECT_NEAR(judge(ten_seconds(), p).recovery_s.value(), 1.6, 1e-9);
  p.times.over_s = 9.5;
  EXPECT_FALSE(judge(ten_seconds(), p).recovery_s);
  EXPECT_FALSE(judge(ten_seconds(), p).good()) << "it never recovered";
  p.times = {};
  EXPECT_TRUE(judge(ten_seconds(), p).good()) << "nothing was to recover from";
}

TEST(Verdict, AWrongOneSpoilsAllAndSoDoesNone) {
  Performed p = performed();
  p.story.replies.back().wrong = true;
  EXPECT_FALSE(judge(ten_seconds(), p).good());
  p.story.replies.clear();
  p.times = {};
  EXPECT_FALSE(judge(ten_seconds(), p).good());
}

TEST(Verdict, RunsOfOneScenarioAreOneRow) {
  std::vector<Verdict> runs(3, judge(ten_seconds(), performed()));
  runs[1].recovery_s = 4;
  const std::string table = to_table(runs);
  EXPECT_THAT(table, HasSubstr("| silence | 3 | 25.0 % | 27 | 12 | 12 | 0 | 0.10 s (0.10) | 0.10 s (0.10) | "
                               "2.10 s (2.10) | 5.00 s (5.00) | 1.60 s (4.00) |"));
  runs[2].recovery_s.reset();
  EXPECT_THAT(to_table(runs), HasSubstr("| never in 1 |"));
  EXPECT_THAT(to_json(runs), HasSubstr("\"recovery_s\": null"));
}

TEST(Scenarios, HaveNamesOfTheirOwnAndFitTheRecording) {
  std::vector<std::string> names;
  for (const Scenario& scenario : scenarios()) {
    EXPECT_THAT(names, testing::Not(testing::Contains(scenario.name)));
    names.push_back(scenario.name);
    EXPECT_LE(scenario.seconds, kLongest_s) << scenario.name;
    EXPECT_TRUE(std::ranges::is_sorted(scenario.acts, {}, &Act::at_s)) << scenario.name;
    EXPECT_TRUE(scenario_named(scenario.name));
  }
  const auto none = scenario_named("earthquake");
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("server-killed"));
}

}  // namespace
}  // namespace liloc::faults
