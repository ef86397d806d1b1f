#include "server/app/site_page.hpp"

#include <gmock/gmock.h>

#include "common/recording/tests/temporary_folder.hpp"

namespace liloc {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;

view::Source nothing() {
  view::Source source;
  source.facts = [] { return web::ServerFacts{}; };
  source.moment = [] { return std::shared_ptr<const Snapshot>(); };
  source.journal = std::make_shared<view::Journal>();
  return source;
}

TEST(SitePage, OnThisHostNobodyNeedsAToken) {
  SitePage page;
  EXPECT_EQ(page.port(), 0);
  ASSERT_TRUE(page.open({}, "", nothing()));
  EXPECT_GT(page.port(), 0);
  EXPECT_EQ(page.url(), "http://127.0.0.1:" + std::to_string(page.port()) + "/");
  page.close();
  EXPECT_EQ(page.port(), 0);
}

TEST(SitePage, TheTokenThatItMadeUpOutlivesIt) {
  const auto token_of = [](const SitePage& page) { return page.url().substr(page.url().find('?')); };
  SitePage page;
  ASSERT_TRUE(page.open({"0.0.0.0", 0}, "", nothing()));
  EXPECT_THAT(page.url(), MatchesRegex("http://0.0.0.0:[0-9]+/.token=[0-9a-f]+"));
  const std::string token = token_of(page);
  page.close();
  ASSERT_TRUE(page.open({"0.0.0.0", 0}, "", nothing()));
  EXPECT_EQ(token_of(page), token);
}

TEST(SitePage, ATokensFileIsKeptToAndNotToldAndTroubleNamesTheOption) {
  const TemporaryFolder folder;
  SitePage page;
  ASSERT_TRUE(page.open({"0.0.0.0", 0}, folder.put("token", "0123456789abcdef\n"), nothing()));
  EXPECT_THAT(page.url(), MatchesRegex("http://0.0.0.0:[0-9]+/"));
  EXPECT_THAT(page.open({}, folder.put("short", "x\n"), nothing()).error().message, HasSubstr("--web-token: "));
  EXPECT_THAT(page.open({"192.0.2.1", 0}, "", nothing()).error().message, HasSubstr("--web: "));
}

}  // namespace
}  // namespace liloc
