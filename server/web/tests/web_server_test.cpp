#include "server/web/web_server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "server/web/tests/http.hpp"

namespace liloc::web {
namespace {

using test::answer_to;
using test::get;
using testing::HasSubstr;
using testing::StartsWith;

std::unique_ptr<WebServer> served() {
  auto server = WebServer::start({}, {{"/fine",
                                       [] {
                                         return Page{200, "hello\n"};
                                       }},
                                      {"/ill",
                                       [] {
                                         return Page{503, "not now\n"};
                                       }},
                                      {"/broken", []() -> Page { throw std::runtime_error("out of order"); }}});
  EXPECT_TRUE(server) << server.error().message;
  return std::move(*server);
}

TEST(WebServer, ServesItsPagesAndNothingElse) {
  const auto server = served();
  ASSERT_GT(server->port(), 0);
  EXPECT_THAT(get(server->port(), "/fine"), StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_THAT(get(server->port(), "/fine"), testing::EndsWith("\r\n\r\nhello\n"));
  EXPECT_THAT(get(server->port(), "/fine?x=1"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(get(server->port(), "/ill"), StartsWith("HTTP/1.1 503"));
  for (const char* path : {"/", "/fine/more", "/etc/passwd", "/../../etc/passwd", "/%2e%2e/etc/passwd"})
    EXPECT_THAT(get(server->port(), path),
                testing::AnyOf(StartsWith("HTTP/1.1 404"), StartsWith("HTTP/1.1 400")))
        << path;
}

TEST(WebServer, AnswersGetAndHeadAlone) {
  const int port = served()->port();
  EXPECT_EQ(get(port, "/fine"), "") << "it is gone";
  const auto server = served();
  const std::string head = answer_to(server->port(), "HEAD /fine HTTP/1.1\r\nHost: here\r\n\r\n");
  EXPECT_THAT(head, HasSubstr("Content-Length: 6"));
  EXPECT_THAT(head, testing::EndsWith("\r\n\r\n"));
  EXPECT_THAT(answer_to(server->port(), "POST /fine HTTP/1.1\r\nHost: here\r\nContent-Length: 0\r\n\r\n"),
              StartsWith("HTTP/1.1 405"));
}

TEST(WebServer, APageThatThrowsAndStrangersBytesDoNotEndIt) {
  const auto server = served();
  EXPECT_THAT(get(server->port(), "/broken"), StartsWith("HTTP/1.1 500"));
  (void)answer_to(server->port(), std::string("\0\xff garbage\r\n\r\n", 13));
  (void)answer_to(server->port(), "GET /" + std::string(100'000, 'a') + " HTTP/1.1\r\n\r\n");
  EXPECT_THAT(get(server->port(), "/fine"), StartsWith("HTTP/1.1 200"));
}

TEST(WebServer, AnAddressThatIsTakenIsNamedWithTheRemedy) {
  const auto first = served();
  const auto second = WebServer::start({"127.0.0.1", first->port()}, {});
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message, HasSubstr(fmt::format("127.0.0.1:{}", first->port())));
  EXPECT_THAT(second.error().message, HasSubstr("free the port"));
}

}  // namespace
}  // namespace liloc::web
