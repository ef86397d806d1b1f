#include "server/answers/answer_file.hpp"

#include <gmock/gmock.h>

#include "common/recording/files.hpp"
#include "common/recording/tests/temporary_folder.hpp"
#include "server/answers/compression.hpp"
#include "server/answers/explanation.hpp"
#include "server/answers/tests/walked.hpp"

namespace liloc::answers {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class SavedAgain : public testing::TestWithParam<unsigned> {};

TEST_P(SavedAgain, GivesTheSameAnswerToTheDigit) {
  const Walked walked(GetParam(), 9);
  ASSERT_EQ(walked.answers.size(), 9U);
  bool followed = false, searched = false;
  for (const Answered& answered : walked.answers) {
    const auto saved = from_bytes(to_bytes(answered), "x.answer");
    ASSERT_TRUE(saved) << saved.error().message;
    const Explanation explanation = explain(*saved);
    EXPECT_THAT(explanation.differences, IsEmpty()) << "request " << answered.request.seq;
    followed |= answered.before && answered.before->followed;
    searched |= !explanation.again.answer.evidence.places.empty();
  }
  EXPECT_TRUE(searched);
  EXPECT_TRUE(followed) << "the session's memory must have counted";
}
INSTANTIATE_TEST_SUITE_P(Seeds, SavedAgain, testing::Values(3U, 7U));

TEST(AnswerFile, ASessionsMemoryCounts) {
  const Walked walked(3, 3);
  Answered forgetful = walked.answers.back();
  ASSERT_TRUE(forgetful.before);
  forgetful.before.reset();
  const auto saved = from_bytes(to_bytes(forgetful), "x.answer");
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_FALSE(explain(*saved).differences.empty());
}

TEST(AnswerFile, WhetherTheServerHadTimeCounts) {
  const Walked walked(3, 9);
  const auto searched_beside = std::ranges::find_if(walked.answers, [](const Answered& answered) {
    return answered.before && answered.before->followed && !run_again(answered).answer.evidence.places.empty();
  });
  ASSERT_NE(searched_beside, walked.answers.end());
  Answered busy = *searched_beside;
  busy.spare_time = false;
  const auto saved = from_bytes(to_bytes(busy), "x.answer");
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_TRUE(run_again(saved->answered).answer.evidence.places.empty());
}

TEST(AnswerFile, AnUnusableCloudIsKeptAsWell) {
  Walked walked(3, 1);
  SpotRequest request = walked.world.request(1, walked.world.truth(1));
  request.lpc.bytes.resize(5);
  walked.world.watch(1);
  (void)walked.world.localizer->locate(request);
  ASSERT_EQ(walked.answers.size(), 2U);
  EXPECT_EQ(walked.answers.back().reply.reason, Reason::bad_cloud);
  const auto saved = from_bytes(to_bytes(walked.answers.back()), "x.answer");
  ASSERT_TRUE(saved) << saved.error().message;
  const Explanation explanation = explain(*saved);
  EXPECT_THAT(explanation.differences, IsEmpty());
  EXPECT_THAT(to_text(*saved, explanation), HasSubstr("bad_cloud"));
}

TEST(AnswerFile, ForeignOldAndDamagedFilesAreOneClearError) {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& bytes) {
    const auto read = read_answer(folder.put("x.answer", bytes));
    return read ? std::string("read") : read.error().message;
  };
  std::string good = to_bytes(Walked(3, 1).answers.front());
  EXPECT_EQ(message(good), "read");
  EXPECT_THAT(message(""), HasSubstr("is no saved answer"));
  EXPECT_THAT(message("LILOCANS"), HasSubstr("is no saved answer"));
  EXPECT_THAT(message("something else altogether"), HasSubstr("is no saved answer"));
  EXPECT_THAT(message(good.substr(0, good.size() / 2)), HasSubstr("damaged"));
  std::string newer = good;
  newer[8] = 9;
  EXPECT_THAT(message(newer), HasSubstr("version 9"));
  good[good.size() / 2] = static_cast<char>(good[good.size() / 2] ^ 1);
  EXPECT_THAT(message(good), HasSubstr("damaged"));
  EXPECT_THAT(read_answer(folder.path() / "absent").error().message, HasSubstr("no such file"));
}

/// Hostile bytes under a sound checksum: whatever stands there, an error or an answer, never a crash.
TEST(AnswerFile, NoByteOfThePayloadIsTrusted) {
  const std::string good = to_bytes(Walked(3, 2).answers.back());
  const std::string head = good.substr(0, 12);
  const std::string payload = *decompressed(std::string_view(good).substr(12), std::size_t{1} << 30);
  const auto read = [&](const std::string& bytes) { return from_bytes(head + compressed(bytes), "x"); };
  ASSERT_TRUE(read(payload));
  const auto spoiled = [&](std::size_t at) {
    std::string bad = payload;
    for (std::size_t i = at; i < std::min(at + 4, bad.size()); ++i) bad[i] = static_cast<char>(0xFF);
    return bad;
  };
  for (const std::size_t options : {0U, 7U, 15U})  // method, voxel size and sampling come first
    EXPECT_FALSE(read(spoiled(options))) << options;
  for (std::size_t at = 0; at < payload.size();
       at += at < 2000 || at + 2000 > payload.size() ? 97 : payload.size() / 9)
    (void)read(spoiled(at));
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, payload.size() / 3, payload.size() - 1})
    EXPECT_FALSE(read(payload.substr(0, size))) << size;
  EXPECT_FALSE(read(payload + "x")) << "more than belongs there";
}

}  // namespace
}  // namespace liloc::answers
