#include "server/answers/explanation.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "server/answers/tests/walked.hpp"

namespace liloc::answers {
namespace {

using testing::HasSubstr;

SavedAnswer saved(const Answered& answered) {
  return *from_bytes(to_bytes(answered), "x.answer");
}

std::size_t count(const std::vector<Marked>& points, Word word) {
  return static_cast<std::size_t>(std::ranges::count(points, word, &Marked::word));
}

TEST(Explanation, ItsPointsSayWhatTheJudgeSays) {
  const Walked walked(3, 1);
  const SavedAnswer answer = saved(walked.answers.front());
  const Explanation e = explain(answer);
  ASSERT_TRUE(e.T_map_sensor);
  const double points = static_cast<double>(e.device.size());
  EXPECT_NEAR(static_cast<double>(count(e.device, Word::agrees)) / points, e.judgement.agree, 1e-9);
  EXPECT_NEAR(static_cast<double>(count(e.device, Word::contradicts)) / points, e.judgement.conflict, 1e-9);
  EXPECT_GT(count(e.device, Word::missing), 0U) << "two LiDARs do not see it all";
  EXPECT_GT(count(e.ceiling, Word::agrees), 0U);
}

TEST(Explanation, TheRisksAddUpToTheConfidence) {
  const Walked walked(3, 1);
  const SavedAnswer answer = saved(walked.answers.front());
  const Explanation e = explain(answer);
  ASSERT_FALSE(e.again.answer.evidence.places.empty());
  const Risks risks = risks_of(e.again.answer.evidence.places);
  EXPECT_EQ(risks.rivals.size() + 1, e.again.answer.evidence.places.size());
  EXPECT_NEAR(probability_of(-std::log(risks.sum())), answer.answered.reply.confidence, 1e-12);
  const std::string text = to_text(answer, e);
  for (const char* part : {"the same to the digit", "places found", "clutter", "twin", "does not see"})
    EXPECT_THAT(text, HasSubstr(part));
  const auto json = nlohmann::json::parse(to_json(answer, e));
  EXPECT_TRUE(json["same_to_the_digit"]);
  EXPECT_NEAR(json["odds_against"]["clutter"].get<double>(), risks.clutter, 1e-12);
}

TEST(Explanation, AnotherAnswerIsTold) {
  const Walked walked(3, 1);
  SavedAnswer answer = saved(walked.answers.front());
  answer.answered.reply.fitness += 1e-9;
  answer.answered.reply.T_map_sensor->translation().x() += 0.5;
  const Explanation e = explain(answer);
  EXPECT_EQ(e.differences.size(), 2U);
  EXPECT_THAT(to_text(answer, e), HasSubstr("0.5 m"));
}

TEST(Explanation, IsDrawnFromAboveAndFromTheSide) {
  const Walked walked(3, 1);
  const SavedAnswer answer = saved(walked.answers.front());
  const std::string svg = to_svg(answer, explain(answer), "a < b & c");
  EXPECT_TRUE(svg.starts_with("<svg "));
  EXPECT_TRUE(svg.ends_with("</svg>\n"));
  for (const char* part : {"from above", "from the side", "a &lt; b &amp; c", "ceiling1"})
    EXPECT_THAT(svg, HasSubstr(part));
  EXPECT_LT(svg.size(), 1'000'000U);
  EXPECT_THAT(svg, testing::Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace liloc::answers
