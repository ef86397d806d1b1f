#include "common/credentials/end_of_credentials.hpp"

#include <gmock/gmock.h>

#include "common/base/log.hpp"
#include "keystore.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A device whose certificate ends in three days, and what the log says of it.
class EndOf : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(store.run("init") && store.run("device robot1 --days 3"));
    log::set_sink([this](log::Level, std::string_view line) { lines.emplace_back(line); });
    end.emplace(store.party("robot1"), start);
  }
  void TearDown() override { log::set_sink({}); }
  std::vector<std::string> said(std::chrono::minutes after) {
    lines.clear();
    end->look(start + after);
    return lines;
  }

  const Keystore store;
  const EndOfCredentials::Time start = std::chrono::steady_clock::now();
  std::vector<std::string> lines;
  std::optional<EndOfCredentials> end;
};

TEST_F(EndOf, ItIsToldOnceADay) {
  EXPECT_THAT(said(23h), IsEmpty()) << "the start has told it";
  const auto told = ElementsAre(HasSubstr("cert.pem expires in 2 days; deploy/credentials renew robot1"));
  EXPECT_THAT(said(24h), told);
  EXPECT_THAT(said(47h), IsEmpty());
  EXPECT_THAT(said(48h), told);
}

TEST_F(EndOf, ARenewedOneCountsWhenTheProgramIsStartedAgain) {
  ASSERT_TRUE(store.run("renew robot1 --days 100"));
  EXPECT_THAT(said(24h),
              ElementsAre(HasSubstr("cert.pem was renewed; the one in use expires in 2 days: start")));
  end.emplace(store.party("robot1"), start);
  EXPECT_THAT(said(24h), IsEmpty());
}

TEST_F(EndOf, AFolderThatCannotBeUsedAtTheNextStartIsTold) {
  std::filesystem::remove(store.party("robot1") / "key.pem");
  EXPECT_THAT(said(24h), ElementsAre(HasSubstr("key.pem is missing")));
}

TEST_F(EndOf, WithoutCredentialsThereIsNothingToSay) {
  end.emplace("", start);
  EXPECT_THAT(said(24h), IsEmpty());
}

}  // namespace
}  // namespace liloc
