// Metrics and health of a whole server over HTTP, and whether the dashboard and the alerts ask for what it
// tells.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <thread>

#include "common/wire/sensors/sensor_publishers.hpp"
#include "server/app/server.hpp"
#include "server/web/tests/http.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;
using test::get;
using testing::HasSubstr;
using testing::StartsWith;

constexpr Camera kCamera{64, 48, 50, 50, 32, 24, 0.001};
constexpr int kDomain = 164;

std::string file(const std::string& path) {
  std::ifstream in(std::string(LILOC_ROOT) + "/" + path);
  EXPECT_TRUE(in) << path;
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The names of the figures in a text, histograms by their family's.
std::set<std::string> names_in(const std::string& text, const std::string& pattern) {
  const std::regex name(pattern), part("_(bucket|sum|count)$");
  std::set<std::string> names;
  for (std::sregex_iterator it(text.begin(), text.end(), name), end; it != end; ++it)
    names.insert(std::regex_replace((*it)[1].str(), part, ""));
  return names;
}

bool eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 500; ++i, std::this_thread::sleep_for(10ms))
    if (holds()) return true;
  return false;
}

/// A server with one LiDAR, which has not sent yet.
class Web : public testing::Test {
 protected:
  void SetUp() override {
    ServerOptions options;
    options.seat = {.domain = kDomain, .role = wire::Role::server};
    options.metrics = web::Address{};
    Site site;
    site.global_lidars = {{"ceiling0", kCamera, 10, Pose::Identity()}};
    auto started = Server::start(options, site);
    ASSERT_TRUE(started) << started.error().message;
    server = std::move(*started);
    port = server->metrics_port();
  }
  void send_a_frame() {
    const auto seat = wire::Participant::create({.domain = kDomain});
    ASSERT_TRUE(seat);
    const auto ceiling = wire::DepthPublisher::create(*seat, "ceiling0", kCamera);
    ASSERT_TRUE(ceiling);
    ASSERT_TRUE(eventually([&] { return ceiling->readers() == 1; }));
    DepthImage image{1'000'000'000, kCamera.width, kCamera.height, {}};
    image.units.assign(64 * 48, 3000);
    std::fill_n(image.units.begin(), 64 * 12, 0);
    ASSERT_TRUE(ceiling->publish(image));
    ASSERT_TRUE(eventually([&] { return server->status().lidars[0].frames == 1; }));
  }
  std::unique_ptr<Server> server;
  int port = 0;
};

TEST_F(Web, IsReadyOnceALidarIsHeardAndGoneAfterTheStop) {
  EXPECT_THAT(get(port, "/healthz"), StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(get(port, "/readyz"), StartsWith("HTTP/1.1 503"));
  send_a_frame();
  EXPECT_THAT(get(port, "/readyz"), StartsWith("HTTP/1.1 200"));
  const std::string metrics = get(port, "/metrics");
  EXPECT_THAT(metrics, HasSubstr("liloc_lidar_frames_total{lidar=\"ceiling0\"} 1"));
  EXPECT_THAT(metrics, HasSubstr("liloc_lidar_valid_share{lidar=\"ceiling0\"} 0.75"));
  server->stop();
  EXPECT_EQ(get(port, "/healthz"), "");
}

TEST_F(Web, DashboardAndAlertsAskForWhatItTellsAndForAllOfIt) {
  send_a_frame();
  const auto told = names_in(get(port, "/metrics"), "# TYPE (\\w+) ");
  ASSERT_GT(told.size(), 15U);
  const std::string dashboard = file("deploy/grafana/liloc.json"),
                    alerts = file("deploy/prometheus/liloc-alerts.yml");
  std::string queries;
  const auto parsed = nlohmann::json::parse(dashboard);
  for (const auto& panel : parsed.at("panels"))
    if (panel.contains("targets"))
      for (const auto& target : panel.at("targets")) queries += target.at("expr").get<std::string>() + "\n";
  const std::string figure = "\\b((?:liloc|process)_\\w+)";
  const auto shown = names_in(queries, figure);
  EXPECT_EQ(shown, told);
  std::string expressions;
  const std::regex line("expr: (.*)");
  for (std::sregex_iterator it(alerts.begin(), alerts.end(), line), end; it != end; ++it)
    expressions += (*it)[1].str() + "\n";
  const auto watched = names_in(expressions, figure);
  EXPECT_GE(watched.size(), 6U);
  for (const auto& name : watched) EXPECT_TRUE(told.contains(name)) << name << " in liloc-alerts.yml";
}

TEST(WebOfAServer, AnAddressThatIsTakenIsAnErrorAndNotThere) {
  ServerOptions options;
  options.seat = {.domain = kDomain, .role = wire::Role::server};
  options.metrics = web::Address{"192.0.2.1", 9464};  // of no host
  Site site;
  site.global_lidars = {{"ceiling0", kCamera, 10, Pose::Identity()}};
  const auto server = Server::start(options, site);
  ASSERT_FALSE(server);
  EXPECT_THAT(server.error().message, HasSubstr("--metrics: cannot listen on 192.0.2.1:9464"));
}

}  // namespace
}  // namespace liloc
