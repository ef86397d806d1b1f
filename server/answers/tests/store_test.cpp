#include "server/answers/store.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "common/recording/tests/temporary_folder.hpp"
#include "server/answers/answer_file.hpp"
#include "server/answers/tests/walked.hpp"

namespace liloc::answers {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::ranges::sort(names);
  return names;
}

TEST(StoreOptions, NameAFolderAndWhatIsKept) {
  EXPECT_EQ(store_options_from("out")->which, Which::refused);
  EXPECT_EQ(store_options_from("out:all")->which, Which::all);
  EXPECT_EQ(store_options_from("a:b/out:wrong")->which, Which::wrong);
  EXPECT_EQ(store_options_from("a:b/out:wrong")->folder, "a:b/out");
  EXPECT_EQ(store_options_from("out:some")->folder, "out:some") << "a folder may have any name";
  EXPECT_THAT(store_options_from(":all").error().message, HasSubstr("no folder"));
}

TEST(AnswerStore, KeepsTheNewestAndWhatIsNotItsOwn) {
  const TemporaryFolder folder;
  folder.put("notes.txt", "mine");
  folder.put("mine.answer", "mine");
  const auto store = AnswerStore::open({folder.path(), Which::all, 2});
  ASSERT_TRUE(store);
  const Walked walked(3, 3);
  for (const Answered& answered : walked.answers) ASSERT_TRUE(store->save(answered));
  EXPECT_THAT(names_in(folder.path()),
              ElementsAre("01700000000800000000-robot-2.answer", "01700000001600000000-robot-3.answer",
                          "mine.answer", "notes.txt"));
  const auto read = read_answer(folder.path() / "01700000001600000000-robot-3.answer");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->answered.request.seq, 3U);
}

TEST(AnswerStore, TheOldestIsWhatWasWrittenFirstWhateverItsStampSays) {
  const TemporaryFolder folder;
  const auto store = AnswerStore::open({folder.path(), Which::all, 2});
  ASSERT_TRUE(store);
  const Walked walked(3, 3);
  for (std::size_t i = 3; i-- > 0;) {  // the newest stamp first, as of a device whose clock runs ahead
    ASSERT_TRUE(store->save(walked.answers[i]));
    for (const std::string& name : names_in(folder.path()))
      fs::last_write_time(folder.path() / name,
                          fs::last_write_time(folder.path() / name) - std::chrono::hours(1));
  }
  EXPECT_THAT(names_in(folder.path()),
              ElementsAre("01700000000000000000-robot-1.answer", "01700000000800000000-robot-2.answer"));
}

TEST(AnswerStore, StaysBelowItsBytes) {
  const TemporaryFolder folder;
  const Walked walked(3, 3);
  const std::size_t one = to_bytes(walked.answers.front()).size();
  const auto store = AnswerStore::open({folder.path(), Which::all, 100, one / 2});
  ASSERT_TRUE(store);
  for (const Answered& answered : walked.answers) ASSERT_TRUE(store->save(answered));
  EXPECT_THAT(names_in(folder.path()), testing::IsEmpty()) << "not even one may be larger than all";
}

TEST(AnswerStore, AFileInTheWayIsAnErrorThatNamesIt) {
  const TemporaryFolder folder;
  const auto store = AnswerStore::open({folder.put("taken", "x"), Which::all});
  ASSERT_FALSE(store);
  EXPECT_THAT(store.error().message, HasSubstr("taken"));
}

TEST(AnswerKeeper, WritesWhatWasAskedForBeforeItEnds) {
  const TemporaryFolder folder;
  Walked walked(3, 4);
  std::size_t refused = 0;
  {
    AnswerKeeper keeper(*AnswerStore::open({folder.path(), Which::refused}));
    walked.answers.front().reply.status = SpotStatus::refused;
    for (const Answered& answered : walked.answers) {
      refused += !answered.reply.verified();
      keeper.keep(answered);
    }
  }
  EXPECT_LT(refused, 4U);
  EXPECT_EQ(names_in(folder.path()).size(), refused);
}

}  // namespace
}  // namespace liloc::answers
