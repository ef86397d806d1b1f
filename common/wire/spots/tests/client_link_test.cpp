#include "common/wire/spots/client_link.hpp"

#include "common/wire/spots/tests/ends.hpp"

namespace liloc::wire {
namespace {

using namespace std::chrono_literals;

TEST(ClientLink, ARequestIsAnsweredWithAllItsFields) {
  Server server(101);
  Client client(101, "robot1");
  ASSERT_TRUE(eventually([&] { return client.link->server_matched(); }));
  const SpotRequest sent = sample_request();
  ASSERT_TRUE(client.link->send(sent));
  const auto arrival = server.arrivals.take();
  ASSERT_TRUE(arrival);
  EXPECT_EQ(arrival->problem, Reason::none) << arrival->text;
  EXPECT_EQ(arrival->from.client_id, "robot1");
  EXPECT_EQ(arrival->request.seq, sent.seq);
  EXPECT_EQ(arrival->request.local_poses.size(), 2U);
  EXPECT_FALSE(arrival->request.local_poses.front().informative);
  EXPECT_EQ(arrival->request.lpc.bytes, sent.lpc.bytes);
  EXPECT_TRUE(arrival->request.T_odom_sensor.isApprox(sent.T_odom_sensor));
  EXPECT_EQ(arrival->request.up_sensor, sent.up_sensor);
  EXPECT_TRUE(arrival->request.cold);

  ASSERT_TRUE(server.link->reply(arrival->from, sample_reply(sent)));
  const auto reply = client.replies.take();
  ASSERT_TRUE(reply);
  const SpotReply expected = sample_reply(sent);
  EXPECT_EQ(reply->seq, sent.seq);
  EXPECT_EQ(reply->status, SpotStatus::verified);
  EXPECT_EQ(reply->reason, Reason::confirmed);
  EXPECT_EQ(reply->server_id, "edge1");
  EXPECT_EQ(reply->text, expected.text);
  EXPECT_EQ(reply->covariance, expected.covariance);
  ASSERT_TRUE(reply->T_map_sensor && reply->T_map_odom);
  EXPECT_TRUE(reply->T_map_odom->isApprox(*expected.T_map_odom));
}

TEST(ClientLink, AClientSeesTheServerComeAndGo) {
  Client client(107, "robot1");
  EXPECT_FALSE(client.link->send(sample_request()));
  {
    Server server(107);
    EXPECT_EQ(client.server.take(), true);
  }
  EXPECT_EQ(client.server.take(), false);
  const auto sent = client.link->send(sample_request());
  ASSERT_FALSE(sent);
  EXPECT_NE(sent.error().message.find("no server"), std::string::npos);
}

TEST(ClientLink, ARestartedClientDoesNotHearTheRepliesToItsEarlierRun) {
  Server server(108);
  Sender earlier;
  Client keeper(108, "robot1");  // keeps the partition's reply writer, and so its history, alive
  ASSERT_TRUE(eventually([&] { return keeper.link->server_matched(); }));
  ASSERT_TRUE(keeper.link->send(sample_request("robot1", 1)));
  const auto first = server.arrivals.take();
  ASSERT_TRUE(first);
  ASSERT_TRUE(server.link->reply(first->from, sample_reply(first->request)));
  ASSERT_TRUE(keeper.replies.take());

  Client restarted(108, "robot1");
  ASSERT_TRUE(eventually([&] { return restarted.link->server_matched(); }));
  EXPECT_FALSE(restarted.replies.take(300ms));
  ASSERT_TRUE(restarted.link->send(sample_request("robot1", 1)));
  const auto second = server.arrivals.take();
  ASSERT_TRUE(second);
  EXPECT_NE(second->from.session, first->from.session);
  ASSERT_TRUE(server.link->reply(second->from, sample_reply(second->request)));
  EXPECT_TRUE(restarted.replies.take());
  EXPECT_FALSE(keeper.replies.take(100ms));
}

TEST(ClientLink, TwoDevicesOfOneIdAreToldToBoth) {
  constexpr int kDomain = 117;
  const Participant seat = Participant::create({.domain = kDomain, .role = Role::server}).value();
  const auto dispatcher = Dispatcher::create(seat).value();
  std::unique_ptr<ServerLink> link;
  link = ServerLink::create(*dispatcher, {}, {.on_request = [&](const Arrival& a) {
           static_cast<void>(link->reply(a.from, sample_reply(a.request)));
         }}).value();
  dispatcher->start();
  struct Device {
    Device()
        : seat(Participant::create({.domain = kDomain}).value()),
          dispatcher(Dispatcher::create(seat).value()),
          link(ClientLink::create(*dispatcher, "robot1", {.on_namesake = [this] { ++namesakes; }}).value()) {
      dispatcher->start();
    }
    ~Device() { dispatcher->stop(); }
    std::atomic<int> namesakes = 0;
    Participant seat;
    std::unique_ptr<Dispatcher> dispatcher;
    std::unique_ptr<ClientLink> link;
  };
  Device one, two;
  ASSERT_TRUE(eventually([&] { return one.link->server_matched() && two.link->server_matched(); }));
  for (std::uint64_t seq = 1; seq < 20 && (one.namesakes == 0 || two.namesakes == 0); ++seq) {
    for (const Device* device : {&one, &two}) ASSERT_TRUE(device->link->send(sample_request("robot1", seq)));
    std::this_thread::sleep_for(300ms);
  }
  EXPECT_GT(one.namesakes, 0);
  EXPECT_GT(two.namesakes, 0);
  dispatcher->stop();
}

TEST(ClientLink, AServerThatBeganAnewIsFoundAgain) {
  Client client(107, "robot1");
  for (const int times : {1, 2}) {
    const Server server(107);
    EXPECT_TRUE(eventually([&] { return client.found == times; }));
  }
}

TEST(ClientLink, AnAnnouncementChangesNothingElse) {
  Server server(107);
  Client client(107, "robot1");
  ASSERT_TRUE(eventually([&] { return client.found == 1; }));
  for (int i = 0; i < 20; ++i) client.link->announce();
  ASSERT_TRUE(client.link->send(sample_request("robot1")));
  EXPECT_TRUE(server.arrivals.take());
  EXPECT_EQ(client.found, 1);
}

TEST(ClientLink, RequestsThatCannotTravelAreRefusedByTheSender) {
  Server server(110);
  Client client(110, "robot1");
  ASSERT_TRUE(eventually([&] { return client.link->server_matched(); }));
  EXPECT_FALSE(client.link->send(sample_request("robot2")));
  SpotRequest large = sample_request();
  large.lpc.bytes.assign(300'000, 1);
  const auto sent = client.link->send(large);
  ASSERT_FALSE(sent);
  EXPECT_NE(sent.error().message.find("LPC"), std::string::npos);
}

}  // namespace
}  // namespace liloc::wire
