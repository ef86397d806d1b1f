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

}  // namespace
}  // namespace liloc::load
