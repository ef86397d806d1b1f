#include "server/view/access.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace liloc::view {
namespace {

TEST(Access, FindsAValueInAQuery) {
  EXPECT_EQ(path_of("/scan?device=a"), "/scan");
  EXPECT_EQ(path_of("/"), "/");
  EXPECT_EQ(in_query("/?a=1&token=xyz&b=2", "token"), "xyz");
  EXPECT_EQ(in_query("/?token=", "token"), "");
  EXPECT_EQ(in_query("/?token", "token"), std::nullopt);
  EXPECT_EQ(in_query("/?mytoken=1", "token"), std::nullopt);
  EXPECT_EQ(in_query("/token=1", "token"), std::nullopt);
  EXPECT_EQ(in_query("", "token"), std::nullopt);
}

TEST(Access, FindsAValueInACookie) {
  EXPECT_EQ(in_cookie("a=1; liloc_token=xyz; b=2", "liloc_token"), "xyz");
  EXPECT_EQ(in_cookie("xliloc_token=1", "liloc_token"), std::nullopt);
  EXPECT_EQ(in_cookie(";;;", "liloc_token"), std::nullopt);
}

TEST(Access, ASecretIsTheSameOnlyWhole) {
  EXPECT_TRUE(same_secret("abc", "abc"));
  for (const char* other : {"", "ab", "abd", "abcd", "xbc"}) EXPECT_FALSE(same_secret(other, "abc")) << other;
}

TEST(Access, OnlyNamesOfThisHostNameIt) {
  for (const char* host : {"localhost", "localhost:8080", "127.0.0.1:8080", "127.1.2.3", "[::1]", "[::1]:80"})
    EXPECT_TRUE(names_this_host(host)) << host;
  for (const char* host : {"", "evil.example", "localhost.evil.example", "127.0.0.1.evil.example", "[::2]",
                           "[::1].evil.example", "10.0.0.1"})
    EXPECT_FALSE(names_this_host(host)) << host;
}

TEST(Access, AnOriginIsThatOfItsHost) {
  EXPECT_TRUE(same_origin("http://localhost:8080", "localhost:8080"));
  EXPECT_TRUE(same_origin("https://edge", "edge"));
  EXPECT_FALSE(same_origin("http://localhost:8081", "localhost:8080"));
  EXPECT_FALSE(same_origin("null", "localhost:8080"));
  EXPECT_FALSE(same_origin("http://", ""));
}

TEST(Access, TokensAreMadeUpAndRead) {
  const std::string token = new_token();
  EXPECT_THAT(token, testing::MatchesRegex("[0-9a-f]{32}"));
  EXPECT_NE(token, new_token());
  const auto file = std::filesystem::temp_directory_path() / ("liloc_token_" + std::to_string(getpid()));
  std::ofstream(file) << token << "\r\nmore";
  EXPECT_EQ(token_from(file).value(), token);
  for (const std::string& bad :
       {std::string("short"), std::string(129, 'x'), std::string("with a blank in it, too"), std::string("\n"),
        std::string(100'000, 'x')}) {
    std::ofstream(file) << bad;
    const auto read = token_from(file);
    ASSERT_FALSE(read) << bad.substr(0, 40);
    EXPECT_THAT(read.error().message, testing::HasSubstr("16 to 128"));
  }
  std::filesystem::remove(file);
  EXPECT_THAT(token_from(file).error().message, testing::HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace liloc::view
