// The service over DDS on loopback: a client's requests in, replies out.
#include "server/service/service.hpp"

#include <gtest/gtest.h>

#include <condition_variable>
#include <map>
#include <set>
#include <thread>

#include "common/base/log.hpp"
#include "common/wire/spots/client_link.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;

SpotRequest request(const std::string& client, std::uint64_t seq) {
  SpotRequest r;
  r.client_id = client;
  r.seq = seq;
  r.stamp_ns = static_cast<StampNs>(seq);
  r.lpc.bytes = {1, 2, 3};
  r.view.camera = {320, 240, 228, 228, 160, 120, 0.001};
  return r;
}

struct Client {
  Client(int domain, std::string name)
      : id(std::move(name)),
        seat(wire::Participant::create({.domain = domain}).value()),
        dispatcher(wire::Dispatcher::create(seat).value()),
        link(wire::ClientLink::create(*dispatcher, id, {.on_reply = [this](SpotReply r) {
               take(std::move(r));
             }}).value()) {
    dispatcher->start();
    for (int i = 0; i < 500 && !link->server_matched(); ++i) std::this_thread::sleep_for(10ms);
  }
  ~Client() { dispatcher->stop(); }
  void take(SpotReply reply) {
    const std::scoped_lock lock(mutex);
    replies.push_back(std::move(reply));
    changed.notify_all();
  }
  bool wait_for(std::size_t count) {
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, 10s, [&] { return replies.size() >= count; });
  }

  std::string id;
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<SpotReply> replies;
  wire::Participant seat;
  std::unique_ptr<wire::Dispatcher> dispatcher;
  std::unique_ptr<wire::ClientLink> link;
};

TEST(Service, ASlowLocalizerStillAnswersEveryRequestOfEveryClient) {
  constexpr int kDomain = 131, kClients = 6;
  constexpr std::uint64_t kRequests = 15;
  const auto seat = wire::Participant::create({.domain = kDomain, .role = wire::Role::server});
  ASSERT_TRUE(seat) << seat.error().message;
  auto dispatcher = wire::Dispatcher::create(*seat).value();
  const auto slow = [](const SpotRequest& r) {
    std::this_thread::sleep_for(20ms);
    SpotReply reply = refusal(r, Reason::confirmed, "");
    reply.status = SpotStatus::verified;
    return reply;
  };
  auto service = Service::create(*dispatcher, {.server_id = "edge1", .queue = 3}, {.locate = slow});
  ASSERT_TRUE(service) << service.error().message;
  dispatcher->start();
  {
    std::vector<std::unique_ptr<Client>> clients;
    clients.reserve(kClients);
    for (int c = 0; c < kClients; ++c)
      clients.push_back(std::make_unique<Client>(kDomain, "robot" + std::to_string(c)));
    EXPECT_EQ((*service)->clients(), static_cast<std::size_t>(kClients));
    for (std::uint64_t seq = 1; seq <= kRequests; ++seq, std::this_thread::sleep_for(10ms))
      for (const auto& client : clients) ASSERT_TRUE(client->link->send(request(client->id, seq)));
    std::map<Reason, int> reasons;
    for (const auto& client : clients) {
      ASSERT_TRUE(client->wait_for(kRequests)) << client->id << " has " << client->replies.size();
      std::set<std::uint64_t> seqs;
      for (const auto& reply : client->replies) {
        EXPECT_EQ(reply.client_id, client->id);
        EXPECT_EQ(reply.server_id, "edge1");
        EXPECT_TRUE(seqs.insert(reply.seq).second) << "answered twice";
        ++reasons[reply.reason];
      }
    }
    EXPECT_GT(reasons[Reason::confirmed], 0);
    EXPECT_GT(reasons[Reason::superseded] + reasons[Reason::overloaded], 0);
  }
  (*service)->stop();
  dispatcher->stop();
  EXPECT_EQ((*service)->counters().answered, kClients * kRequests);
}

TEST(Service, AClientThatComesAndGoesCausesALineOfEachKind) {
  std::mutex mutex;
  int here = 0, left = 0;
  log::set_sink([&](log::Level, std::string_view line) {
    const std::scoped_lock lock(mutex);
    here += line.find("is here") != std::string_view::npos;
    left += line.find("has left") != std::string_view::npos;
  });
  const auto seat = wire::Participant::create({.domain = 133, .role = wire::Role::server});
  ASSERT_TRUE(seat);
  auto dispatcher = wire::Dispatcher::create(*seat).value();
  auto service =
      Service::create(*dispatcher, {.server_id = "edge1"},
                      {.locate = [](const SpotRequest& r) { return refusal(r, Reason::confirmed, ""); }});
  ASSERT_TRUE(service);
  dispatcher->start();
  for (int i = 0; i < 4; ++i) {
    const Client client(133, "robot1");
    EXPECT_TRUE(client.link->server_matched());
  }
  for (int i = 0; i < 500 && (*service)->clients() > 0; ++i) std::this_thread::sleep_for(10ms);
  (*service)->stop();
  dispatcher->stop();
  log::set_sink({});
  EXPECT_GE(here, 1);
  EXPECT_LE(here, 2) << "one in five seconds";
  EXPECT_GE(left, 1);
  EXPECT_LE(left, 2);
}

TEST(Service, OptionsAreChecked) {
  const auto seat = wire::Participant::create({.domain = 132, .role = wire::Role::server});
  ASSERT_TRUE(seat);
  auto dispatcher = wire::Dispatcher::create(*seat).value();
  EXPECT_FALSE(Service::create(*dispatcher, {.workers = -1}, {}));
}

}  // namespace
}  // namespace liloc
