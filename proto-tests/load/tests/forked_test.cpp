#include "proto-tests/load/forked.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>

namespace liloc::load {
namespace {

using testing::HasSubstr;

TEST(Forked, HandsBackWhatItsWorkReturned) {
  const std::string shared = "computed before; ";
  auto forked = Forked::start([&]() -> Result<std::string> { return shared + std::string(300'000, 'x'); });
  ASSERT_TRUE(forked) << forked.error().message;
  const auto bytes = forked->collect();
  ASSERT_TRUE(bytes) << bytes.error().message;
  EXPECT_EQ(bytes->size(), shared.size() + 300'000);
  EXPECT_TRUE(bytes->starts_with(shared));
}

TEST(Forked, TellsWhatWentWrong) {
  const auto error_of = [](const std::function<Result<std::string>()>& work) {
    auto forked = Forked::start(work);
    const auto bytes = forked->collect();
    return bytes ? "no error" : bytes.error().message;
  };
  EXPECT_EQ(error_of([]() -> Result<std::string> { return fail("no domain is free"); }), "no domain is free");
  EXPECT_THAT(error_of([]() -> Result<std::string> { throw std::runtime_error("bug"); }), HasSubstr("bug"));
  EXPECT_THAT(error_of([]() -> Result<std::string> {
                kill(getpid(), SIGKILL);
                return "";
              }),
              HasSubstr("killed by signal 9"));
}

TEST(Forked, EndsWithItsOwner) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  {
    const auto forked = Forked::start([&]() -> Result<std::string> {
      pause();
      return "";
    });
    ASSERT_TRUE(forked);
    close(ends[1]);
  }
  char byte = 0;
  EXPECT_EQ(read(ends[0], &byte, 1), 0) << "the child still holds its end";
  close(ends[0]);
}

TEST(Rows, AreTakenInTheOrderInWhichTheyWereAppended) {
  struct Row {
    double at_s;
    bool good;
  };
  std::string bytes;
  append_rows(std::vector<Row>{{1.5, true}, {2.5, false}}, bytes);
  append_rows(std::vector<std::uint64_t>{}, bytes);
  append_rows(std::vector<std::uint64_t>{7}, bytes);
  std::string_view rest = bytes;
  std::vector<Row> rows{{0.5, false}};
  std::vector<std::uint64_t> counts;
  take_rows(rest, rows);
  take_rows(rest, counts);
  EXPECT_TRUE(counts.empty());
  take_rows(rest, counts);
  ASSERT_EQ(rows.size(), 3U) << "those of several processes are put together";
  EXPECT_EQ(rows[2].at_s, 2.5);
  EXPECT_TRUE(rows[1].good);
  EXPECT_EQ(counts, std::vector<std::uint64_t>{7});
  EXPECT_TRUE(rest.empty());
}

}  // namespace
}  // namespace liloc::load
