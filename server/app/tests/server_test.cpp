// The whole server over DDS on loopback, with one small LiDAR.
#include "server/app/server.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

#include "common/codec/codec.hpp"
#include "common/recording/tests/temporary_folder.hpp"
#include "common/wire/sensors/sensor_publishers.hpp"
#include "common/wire/spots/client_link.hpp"
#include "server/answers/answer_file.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;

constexpr Camera kCamera{64, 48, 50, 50, 32, 24, 0.001};

Site small_site() {
  Site site;
  site.global_lidars = {{"ceiling0", kCamera, 10, Pose::Identity()}};
  return site;
}

bool eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 500; ++i, std::this_thread::sleep_for(10ms))
    if (holds()) return true;
  return false;
}

SpotRequest request(StampNs stamp_ns, const Cloud& cloud) {
  SpotRequest r;
  r.client_id = "robot1";
  r.seq = 1;
  r.stamp_ns = stamp_ns;
  r.lpc = encode(cloud).value();
  r.view.camera = kCamera;
  return r;
}

TEST(Server, AnswersAClientAndTellsItsStatus) {
  ServerOptions options;
  options.seat = {.domain = 161, .role = wire::Role::server};
  options.service.server_id = options.localizer.server_id = "edge1";
  const TemporaryFolder folder;
  options.save_answers = answers::StoreOptions{folder.path()};
  const auto server = Server::start(options, small_site());
  ASSERT_TRUE(server) << server.error().message;

  const auto seat = wire::Participant::create({.domain = 161});
  ASSERT_TRUE(seat);
  auto dispatcher = wire::Dispatcher::create(*seat).value();
  std::mutex mutex;
  std::optional<SpotReply> reply;
  std::optional<wire::ServerStatus> status;
  const auto link = wire::ClientLink::create(*dispatcher, "robot1", {.on_reply = [&](SpotReply r) {
    const std::scoped_lock lock(mutex);
    reply = std::move(r);
  }});
  ASSERT_TRUE(link);
  ASSERT_TRUE(wire::subscribe_status(*dispatcher, [&](Result<wire::ServerStatus> s) {
    const std::scoped_lock lock(mutex);
    ASSERT_TRUE(s) << s.error().message;
    status = std::move(*s);
  }));
  const auto ceiling = wire::DepthPublisher::create(*seat, "ceiling0", kCamera);
  ASSERT_TRUE(ceiling);
  dispatcher->start();
  ASSERT_TRUE(eventually([&] { return (*link)->server_matched() && ceiling->readers() == 1; }));

  DepthImage image{1'000'000'000, kCamera.width, kCamera.height, {}};
  image.units.assign(64 * 48, 3000);  // a wall 3 m away
  ASSERT_TRUE(ceiling->publish(image));
  const Cloud cloud = depth_to_cloud(image, kCamera).value();
  ASSERT_TRUE((*link)->send(request(image.stamp_ns, cloud)));
  const auto answered = [&] {
    const std::scoped_lock lock(mutex);
    return reply.has_value();
  };
  ASSERT_TRUE(eventually(answered));
  EXPECT_EQ(reply->seq, 1U);
  EXPECT_EQ(reply->server_id, "edge1");
  EXPECT_NE(reply->status, SpotStatus::verified) << "one flat wall cannot say where a device is";
  ASSERT_TRUE(eventually([&] {
    const std::scoped_lock lock(mutex);
    return status && status->answered == 1;
  }));
  EXPECT_EQ(status->server_id, "edge1");
  EXPECT_EQ(status->clients, 1U);
  EXPECT_EQ(status->codecs, std::vector(kCloudCodecs.begin(), kCloudCodecs.end()));
  ASSERT_EQ(status->lidars.size(), 1U);
  EXPECT_EQ(status->lidars[0].id, "ceiling0");
  EXPECT_EQ(status->lidars[0].frames, 1U);
  dispatcher->stop();
  (*server)->stop();
  const auto saved = answers::read_answer(folder.path() / "00000000001000000000-robot1-1.answer");
  ASSERT_TRUE(saved) << saved.error().message;
  EXPECT_EQ(saved->answered.reply.reason, reply->reason);
  EXPECT_EQ(saved->answered.reply.T_map_sensor.has_value(), reply->T_map_sensor.has_value());
}

TEST(Server, TwoOfFourClocksAheadDoNotCarryTheCeilingAway) {
  ServerOptions options;
  options.seat = {.domain = 163, .role = wire::Role::server};
  options.service.server_id = options.localizer.server_id = "edge1";
  Site site;
  std::vector<wire::DepthPublisher> lidars;
  const auto seat = wire::Participant::create({.domain = 163});
  ASSERT_TRUE(seat);
  for (const char* id : {"c0", "c1", "c2", "c3"}) {
    site.global_lidars.push_back({id, kCamera, 10, Pose::Identity()});
    lidars.push_back(wire::DepthPublisher::create(*seat, id, kCamera).value());
  }
  const auto server = Server::start(options, site);
  ASSERT_TRUE(server) << server.error().message;
  ASSERT_TRUE(
      eventually([&] { return std::ranges::all_of(lidars, [](const auto& l) { return l.readers() == 1; }); }));
  const auto corrected = [&](std::size_t i) { return (*server)->status().lidars[i].clock_corrected; };
  StampNs now_ns = 0;
  for (int frame = 0; frame < 100 && !(corrected(0) && corrected(1));
       ++frame, std::this_thread::sleep_for(100ms)) {
    now_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                 std::chrono::system_clock::now().time_since_epoch())
                 .count();
    for (std::size_t i = 0; i < lidars.size(); ++i) {  // those ahead are heard first
      DepthImage image{now_ns + (i < 2 ? from_seconds(37) : 0), kCamera.width, kCamera.height, {}};
      image.units.assign(64 * 48, 3000);
      ASSERT_TRUE(lidars[i].publish(image));
    }
  }
  const auto status = (*server)->status();
  for (const std::size_t i : {0U, 1U, 2U, 3U}) {
    EXPECT_EQ(status.lidars[i].state, wire::LidarState::ok) << wire::name_of(status.lidars[i].state);
    EXPECT_EQ(status.lidars[i].clock_corrected, i < 2);
    EXPECT_NEAR(status.lidars[i].clock_offset_s, i < 2 ? 37 : 0, 0.2);
  }
  (*server)->stop();
}

TEST(Server, AnInterfaceThatIsNotThereIsNamed) {
  ServerOptions options;
  options.seat = {.domain = 162, .role = wire::Role::server, .interface = "nosuchcard0"};
  const auto server = Server::start(options, small_site());
  ASSERT_FALSE(server);
  EXPECT_NE(server.error().message.find("nosuchcard0"), std::string::npos) << server.error().message;
}

}  // namespace
}  // namespace liloc
