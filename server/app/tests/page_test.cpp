// The page of a whole server: a LiDAR and a device over DDS, and what a viewer is told of them.
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "common/codec/codec.hpp"
#include "common/wire/sensors/sensor_publishers.hpp"
#include "common/wire/spots/client_link.hpp"
#include "server/app/server.hpp"
#include "server/view/tests/browser.hpp"
#include "server/view/tests/points.hpp"
#include "server/web/tests/http.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::StartsWith;
using view::test::Browser;

constexpr Camera kCamera{64, 48, 50, 50, 32, 24, 0.001};
constexpr int kDomain = 165;

Site small_site() {
  Site site;
  site.global_lidars = {{"ceiling0", kCamera, 10, Pose::Identity()}};
  return site;
}

ServerOptions with_page(const web::Address& address = {}) {
  ServerOptions options;
  options.seat = {.domain = kDomain, .role = wire::Role::server};
  options.page = address;
  return options;
}

bool eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 500; ++i, std::this_thread::sleep_for(10ms))
    if (holds()) return true;
  return false;
}

std::string get(int port, const std::string& target) {
  return test::answer_to(port, "GET " + target + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
}

/// The next message of a part that is so.
nlohmann::json told(Browser& browser, const std::string& part,
                    const std::function<bool(const nlohmann::json&)>& so) {
  for (int i = 0; i < 500; ++i) {
    const auto message = browser.read();
    if (!message) break;
    if (message->front() != '{') continue;
    if (auto json = nlohmann::json::parse(*message); json["part"] == part && so(json)) return json;
  }
  ADD_FAILURE() << "no such " << part;
  return {};
}

TEST(PageOfAServer, ShowsItsLidarItsDeviceAndWhyThatOneIsNotLocated) {
  const auto tail = std::make_shared<view::LogTail>();
  const auto started = Server::start(with_page(), small_site(), tail);
  ASSERT_TRUE(started) << started.error().message;
  Server& server = **started;
  EXPECT_EQ(server.page_url(), "http://127.0.0.1:" + std::to_string(server.page_port()) + "/");
  const auto seat = wire::Participant::create({.domain = kDomain});
  ASSERT_TRUE(seat);
  auto dispatcher = wire::Dispatcher::create(*seat).value();
  const auto link = wire::ClientLink::create(*dispatcher, "robot1", {.on_reply = [](const SpotReply&) {}});
  ASSERT_TRUE(link);
  const auto ceiling = wire::DepthPublisher::create(*seat, "ceiling0", kCamera);
  ASSERT_TRUE(ceiling);
  dispatcher->start();
  ASSERT_TRUE(eventually([&] { return (*link)->server_matched() && ceiling->readers() == 1; }));
  DepthImage image{1'000'000'000, kCamera.width, kCamera.height, {}};
  image.units.assign(64 * 48, 3000);  // a wall 3 m away, which cannot say where a device is
  ASSERT_TRUE(ceiling->publish(image));

  Browser browser(server.page_port());
  ASSERT_TRUE(browser.looks());
  SpotRequest request;
  request.client_id = "robot1";
  request.seq = 1;
  request.stamp_ns = image.stamp_ns;
  request.lpc = encode(depth_to_cloud(image, kCamera).value()).value();
  request.view.camera = kCamera;
  ASSERT_TRUE((*link)->send(request));
  const auto now = told(browser, "now", [](const auto& json) { return !json["devices"].empty(); });
  EXPECT_EQ(now["lidars"][0]["frames"], 1);
  const auto& device = now["devices"][0];
  EXPECT_EQ(device["id"], "robot1");
  EXPECT_NE(device["status"], "verified");
  EXPECT_EQ(device["scan"], 1);
  const std::string scan = get(server.page_port(), "/scan?device=robot1");
  EXPECT_THAT(scan, StartsWith("HTTP/1.1 200"));
  EXPECT_EQ(scan.ends_with("\r\n\r\n"), device["pose"].is_null()) << "a cloud needs a place";
  tail->add(log::Level::info, "a line");
  told(browser, "log", [](const auto& json) { return json["lines"][0][2] == "a line"; });
  told(browser, "charts", [](const auto& json) { return json["verified"].size() == 120; });
  dispatcher->stop();
  ASSERT_TRUE(server.rejoin(with_page()));
  Browser after(server.page_port());
  EXPECT_TRUE(told(after, "now", [](const auto&) { return true; })["devices"].empty())
      << "whom new credentials may not let in is not shown";
  const int port = server.page_port();
  EXPECT_THAT(get(port, "/"), StartsWith("HTTP/1.1 200"));
  server.stop();
  EXPECT_EQ(get(port, "/"), "");
}

TEST(PageOfAServer, AnAddressThatOthersReachGetsATokenOfItsOwn) {
  const auto server = Server::start(with_page({"0.0.0.0", 0}), small_site());
  ASSERT_TRUE(server) << server.error().message;
  const std::string url = (*server)->page_url();
  EXPECT_THAT(url, testing::MatchesRegex("http://0.0.0.0:[0-9]+/.token=[0-9a-f]+"));
  const int port = (*server)->page_port();
  EXPECT_THAT(get(port, "/"), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(get(port, url.substr(url.find("/?"))), StartsWith("HTTP/1.1 303"));
}

TEST(PageOfAServer, ATokensFileIsKeptToAndNotTold) {
  const auto file = std::filesystem::temp_directory_path() / ("liloc_page_token_" + std::to_string(getpid()));
  std::ofstream(file) << "0123456789abcdef\n";
  ServerOptions options = with_page();
  options.page_token_file = file;
  {
    const auto server = Server::start(options, small_site());
    ASSERT_TRUE(server) << server.error().message;
    EXPECT_THAT(get((*server)->page_port(), "/?token=0123456789abcdef"), StartsWith("HTTP/1.1 303"));
    EXPECT_EQ((*server)->page_url().find("0123456789abcdef"), std::string::npos);
  }
  std::filesystem::remove(file);
  const auto server = Server::start(options, small_site());
  ASSERT_FALSE(server);
  EXPECT_THAT(server.error().message, HasSubstr("--web-token: "));
}

TEST(PageOfAServer, AnAddressOfNoHostIsAnError) {
  const auto server = Server::start(with_page({"192.0.2.1", 8080}), small_site());
  ASSERT_FALSE(server);
  EXPECT_THAT(server.error().message, HasSubstr("--web: cannot listen on 192.0.2.1:8080"));
}

}  // namespace
}  // namespace liloc
