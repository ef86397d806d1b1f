#include "proto-tests/soak/schedule.hpp"

#include <gmock/gmock.h>

namespace liloc::soak {
namespace {

void expect_in_turn(const std::vector<Span>& spans) {
  for (std::size_t i = 0; i < spans.size(); ++i) {
    EXPECT_GT(spans[i].length_s(), 0);
    if (i == 0) continue;
    EXPECT_GT(spans[i].from_s, spans[i - 1].to_s);
  }
}

TEST(SoakSchedule, LidarsGoAndAreBackBeforeTheEnd) {
  SoakOptions options;
  const auto flaps = draw_flaps(options, 0);
  EXPECT_GT(flaps.size(), 10U) << "600 s, a flap every 20 s or so";
  expect_in_turn(flaps);
  EXPECT_GT(flaps.front().from_s, 4);
  EXPECT_LT(flaps.back().to_s, options.seconds);
  EXPECT_NE(flaps.front().from_s, draw_flaps(options, 1).front().from_s) << "each at times of its own";
  EXPECT_EQ(flaps.front().from_s, draw_flaps(options, 0).front().from_s) << "by the seed";
  options.flap_s = 0;
  EXPECT_TRUE(draw_flaps(options, 0).empty());
}

TEST(SoakSchedule, SomebodyIsMostlyInAPlace) {
  SoakOptions options;
  options.stay_s = 12;
  const auto visits = draw_visits(options, 2);
  expect_in_turn(visits);
  double there_s = 0;
  for (const Span& visit : visits) there_s += visit.length_s();
  EXPECT_GT(there_s, 0.8 * options.seconds);
  EXPECT_NEAR(there_s / static_cast<double>(visits.size()), 12, 5);
  EXPECT_LE(visits.back().to_s, options.seconds);
}

}  // namespace
}  // namespace liloc::soak
