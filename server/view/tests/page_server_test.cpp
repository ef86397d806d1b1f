#include "server/view/page_server.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <list>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "server/view/tests/browser.hpp"
#include "server/view/tests/points.hpp"
#include "server/view/tests/source.hpp"
#include "server/web/tests/http.hpp"

namespace liloc::view {
namespace {

using namespace std::chrono_literals;
using liloc::test::answer_to;
using test::Browser;
using test::handshake;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kToken = "0123456789abcdef";

bool eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 500; ++i, std::this_thread::sleep_for(10ms))
    if (holds()) return true;
  return false;
}

class Page : public testing::Test {
 protected:
  void SetUp() override { start(""); }
  void start(const std::string& token) {
    server.reset();
    auto started = PageServer::start({{}, token}, place.source());
    ASSERT_TRUE(started) << started.error().message;
    server = std::move(*started);
    port = server->port();
  }
  std::string get(const std::string& target, const std::string& more = "",
                  const std::string& host = "localhost") const {
    return answer_to(
        port, "GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\nConnection: close\r\n" + more + "\r\n");
  }
  test::Place place;
  std::unique_ptr<PageServer> server;
  int port = 0;
};

TEST_F(Page, IsServedWithAStrictPolicy) {
  for (const char* path : {"/", "/page.js", "/page.css"}) {
    const std::string answer = get(path);
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(answer, HasSubstr("Content-Encoding: gzip"));
    EXPECT_THAT(answer, HasSubstr("default-src 'none'; script-src 'self'"));
    EXPECT_EQ(answer.find("unsafe"), std::string::npos);
    EXPECT_EQ(answer.substr(answer.find("\r\n\r\n") + 4, 2), "\x1f\x8b");
    EXPECT_LT(answer.size(), 200'000U);
  }
}

TEST_F(Page, WhatIsNotThereIsNot) {
  for (const char* path :
       {"/../../etc/passwd", "/%2e%2e/etc/passwd", "/page.js/", "/nothing", "//", "/scan", "/scan?device=../x"})
    EXPECT_THAT(get(path), StartsWith("HTTP/1.1 404")) << path;
  EXPECT_THAT(get("/scan?device=robot1"), HasSubstr("Content-Length: 0")) << "there is no cloud";
  EXPECT_THAT(get("/live"), StartsWith("HTTP/1.1 426"));
}

TEST_F(Page, BadRequestsAreRefusedAndTheNextOnesServed) {
  EXPECT_THAT(get("/", "X: " + std::string(20'000, 'x') + "\r\n"), StartsWith("HTTP/1.1 431"));
  EXPECT_THAT(answer_to(port, "rubbish\r\n\r\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(
      answer_to(port,
                "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 3\r\nConnection: close\r\n\r\nabc"),
      StartsWith("HTTP/1.1 405"));
  EXPECT_THAT(answer_to(port, "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99999999\r\n\r\n"),
              StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(get("/"), StartsWith("HTTP/1.1 200"));
}

TEST_F(Page, WithoutATokenOnlyThisHostsOwnNamesAreServed) {
  EXPECT_THAT(get("/", "", "evil.example"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(get("/", "", "127.0.0.1:80"), StartsWith("HTTP/1.1 200"));
  EXPECT_EQ(handshake(port, "Origin: http://evil.example\r\n"), "HTTP/1.1 403");
  EXPECT_EQ(handshake(port, "Origin: http://localhost:" + std::to_string(port) + "\r\n"), "HTTP/1.1 101");
}

TEST_F(Page, BehindAProxyATokenIsNeeded) {
  EXPECT_THAT(get("/", "X-Forwarded-For: 10.0.0.7\r\n"), StartsWith("HTTP/1.1 403"));
  start(kToken);
  EXPECT_THAT(get("/?token=" + kToken, "X-Forwarded-For: 10.0.0.7\r\n"), StartsWith("HTTP/1.1 303"));
}

TEST_F(Page, ATokenIsAskedOfEveryone) {
  start(kToken);
  const std::string cookie = "liloc_token_" + std::to_string(port) + "=";
  for (const std::string& path :
       {std::string("/"), std::string("/page.js"), std::string("/scan?device=a"), std::string("/?token="),
        "/?token=" + kToken + "x", "/?token=1" + kToken.substr(1)})
    EXPECT_THAT(get(path), StartsWith("HTTP/1.1 401")) << path;
  EXPECT_EQ(handshake(port), "HTTP/1.1 401");
  const std::string let_in = get("/?token=" + kToken);
  EXPECT_THAT(let_in, StartsWith("HTTP/1.1 303"));
  EXPECT_THAT(let_in, HasSubstr("Set-Cookie: " + cookie + kToken + "; HttpOnly; SameSite=Strict"));
  EXPECT_THAT(get("/", "Cookie: " + cookie + kToken + "\r\n", "edge.example"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(get("/", "Cookie: " + cookie + "wrong\r\n"), StartsWith("HTTP/1.1 401"));
  EXPECT_EQ(handshake(port, "Cookie: " + cookie + kToken + "\r\n"), "HTTP/1.1 101");
}

TEST_F(Page, ShowsTheSiteAsItChanges) {
  place.frame();
  Browser browser(port);
  ASSERT_TRUE(browser.looks());
  std::set<std::string> parts;
  for (int i = 0; i < 7; ++i) {
    const auto message = browser.read();
    ASSERT_TRUE(message);
    if (message->front() == '{')
      parts.insert(nlohmann::json::parse(*message)["part"]);
    else if (const auto read = test::read_points(*message); read.kind == 1)
      parts.insert(read.points_map.empty() ? "no room" : "room");
    else
      parts.insert("moving");
  }
  EXPECT_THAT(parts, testing::ElementsAre("charts", "log", "moving", "now", "room", "site", "trails"));
  place.log->add(log::Level::warning, "a LiDAR is silent");
  for (int i = 0; i < 50; ++i)
    if (browser.read().value_or("").find("a LiDAR is silent") != std::string::npos) return;
  FAIL() << "the new line was not told";
}

TEST_F(Page, NobodyLooksAndNothingIsAsked) {
  std::this_thread::sleep_for(500ms);
  EXPECT_EQ(place.asked, 0);
  {
    Browser browser(port);
    ASSERT_TRUE(eventually([&] { return place.asked > 2; }));
  }
  ASSERT_TRUE(eventually([&] {
    const int before = place.asked;
    std::this_thread::sleep_for(500ms);
    return place.asked == before;
  }));
}

/// The number of the next picture that a viewer is told.
double next_picture(Browser& browser) {
  while (const auto message = browser.read())
    if (message->starts_with(R"({"part":"now")")) return nlohmann::json::parse(*message)["uptime_s"];
  ADD_FAILURE() << "no picture came";
  return 1e9;
}

TEST_F(Page, OneThatReadsNothingHoldsUpNobodyAndMissesWhatIsOld) {
  for (std::size_t i = 0; i < kDevicesKept; ++i) {  // 200 kB a picture: the buffers are full after five
    SpotRequest request;
    request.client_id = "device" + std::to_string(i);
    place.journal->answered(refusal(request, Reason::not_found, std::string(200, 'x')),
                            std::chrono::steady_clock::now());
  }
  Browser stuck(port, 4096), quick(port);
  ASSERT_TRUE(stuck.looks());
  const double first = next_picture(quick);
  int told = 0;
  for (double at = first; at < first + 20; at = next_picture(quick)) ++told;
  EXPECT_GE(told, 15) << "the quick one was held up";
  told = 0;
  while (next_picture(stuck) < first + 20) ++told;
  EXPECT_LT(told, 12) << "old pictures were kept for the slow one";
}

TEST_F(Page, The65thViewerIsRefusedAndALaterOneIsNot) {
  std::list<Browser> browsers;
  for (std::size_t i = 0; i < kMostViewers; ++i) ASSERT_TRUE(browsers.emplace_back(port).looks()) << i;
  ASSERT_TRUE(eventually([&] { return handshake(port) == "HTTP/1.1 503"; }));
  EXPECT_THAT(get("/"), StartsWith("HTTP/1.1 200"));
  browsers.pop_front();
  EXPECT_TRUE(eventually([&] { return handshake(port) == "HTTP/1.1 101"; }));
}

TEST_F(Page, AViewerThatSpeaksIsShownOut) {
  Browser browser(port);
  browser.say("turn the lights off");
  while (browser.read()) {
  }
  EXPECT_EQ(browser.close_code(), 1008);
}

TEST_F(Page, MoreConnectionsThanItTakesAreDropped) {
  boost::asio::io_context io;
  std::list<boost::asio::ip::tcp::socket> idle;
  for (std::size_t i = 0; i < kMostConnections; ++i)
    idle.emplace_back(io).connect({boost::asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(port)});
  EXPECT_EQ(get("/"), "");
  idle.clear();
  EXPECT_TRUE(eventually([&] { return get("/").starts_with("HTTP/1.1 200"); }));
}

TEST_F(Page, AStopEndsItForAllViewers) {
  Browser browser(port);
  ASSERT_TRUE(browser.read());
  server.reset();
  while (browser.read()) {
  }
  EXPECT_EQ(get("/"), "");
}

TEST_F(Page, AddressesThatCannotBeAreErrors) {
  const auto error = [&](const web::Address& address, const std::string& token) {
    const auto started = PageServer::start({address, token}, place.source());
    return started ? std::string() : started.error().message;
  };
  EXPECT_THAT(error({"127.0.0.1", port}, ""), HasSubstr("cannot listen on 127.0.0.1:"));
  EXPECT_THAT(error({"192.0.2.1", 0}, kToken), HasSubstr("cannot listen on 192.0.2.1:0"));
  EXPECT_THAT(error({"0.0.0.0", 0}, ""), HasSubstr("a token is needed"));
  EXPECT_THAT(error({"somewhere", 0}, ""), HasSubstr("no numeric address"));
}

}  // namespace
}  // namespace liloc::view
