#include "common/wire/spots/server_link.hpp"

#include <algorithm>

#include "common/base/log.hpp"
#include "common/wire/dds/convert.hpp"
#include "common/wire/spots/tests/ends.hpp"

namespace liloc::wire {
namespace {

using namespace std::chrono_literals;

TEST(ServerLink, ACallbackThatThrowsTakesNothingWithIt) {
  constexpr int kDomain = 100;
  const Participant seat = Participant::create({.domain = kDomain, .role = Role::server}).value();
  const auto dispatcher = Dispatcher::create(seat).value();
  std::atomic<int> ticks = 0;
  Inbox<std::uint64_t> asked;
  const auto link = ServerLink::create(*dispatcher, {}, {.on_request = [&](const Arrival& a) {
                      asked.put(a.request.seq);
                      throw std::runtime_error("out of something");
                    }}).value();
  dispatcher->every(10ms, [&] {
    ++ticks;
    throw std::runtime_error("out of something else");
  });
  dispatcher->start();
  const Forger forger(kDomain, "robots/robot1");
  for (int i = 0; i < 3; ++i) {
    forger.send(sample_request("robot1"));
    EXPECT_TRUE(asked.take()) << "request " << i;
  }
  EXPECT_TRUE(eventually([&] { return ticks > 3; }));
  dispatcher->stop();
}

TEST(ServerLink, AClientThatClaimsAnotherIdIsNamedByItsPartition) {
  Server server(102);
  Forger forger(102, "robots/mallory");
  forger.send(sample_request("robot1"));
  const auto arrival = server.arrivals.take();
  ASSERT_TRUE(arrival);
  EXPECT_EQ(arrival->problem, Reason::identity);
  EXPECT_EQ(arrival->from.client_id, "mallory");
  EXPECT_EQ(arrival->request.client_id, "mallory");
  EXPECT_NE(arrival->text.find("robot1"), std::string::npos);
}

/// The lines of the log, as long as it lives.
struct Lines {
  Lines() {
    log::set_sink([this](log::Level, std::string_view line) {
      const std::scoped_lock lock(mutex);
      lines.emplace_back(line);
    });
  }
  ~Lines() { log::set_sink({}); }
  std::size_t with(std::string_view part) {
    const std::scoped_lock lock(mutex);
    return static_cast<std::size_t>(std::ranges::count_if(
        lines, [&](const std::string& line) { return line.find(part) != std::string::npos; }));
  }
  std::mutex mutex;
  std::vector<std::string> lines;
};

TEST(ServerLink, AForgedNameReachesNoTextAsItIs) {
  Server server(115);
  Forger forger(115, "robots/mallory");
  forger.send(sample_request(), [](auto& m) { copy_text(m.client_id, "a\x1b[2J\nforged"); });
  const auto arrival = server.arrivals.take();
  ASSERT_TRUE(arrival);
  EXPECT_EQ(arrival->problem, Reason::identity);
  EXPECT_EQ(arrival->text, "client_id is a?[2J forged, the sender is mallory");
}

TEST(ServerLink, StrangersByTheDozenAreOneLine) {
  Lines lines;
  Server server(116);
  std::vector<std::unique_ptr<Forger>> strange;
  for (int i = 0; i < 12; ++i)
    strange.push_back(std::make_unique<Forger>(116, "robots/no name " + std::to_string(i)));
  ASSERT_TRUE(eventually([&] { return lines.with("is not in one partition") > 0; }));
  std::this_thread::sleep_for(1s);
  EXPECT_EQ(lines.with("is not in one partition"), 1U);
}

TEST(ServerLink, AnotherProtocolVersionIsReported) {
  Server server(103);
  Forger forger(103, "robots/old");
  forger.send(sample_request("old"), [](auto& message) { message.protocol_version = kProtocolVersion + 1; });
  const auto arrival = server.arrivals.take();
  ASSERT_TRUE(arrival);
  EXPECT_EQ(arrival->problem, Reason::protocol_version) << arrival->text;
  EXPECT_EQ(arrival->request.seq, 7U);
}

TEST(ServerLink, AMalformedRequestIsReportedByField) {
  Server server(104);
  Forger forger(104, "robots/bad");
  forger.send(sample_request("bad"),
              [](auto& message) { message.voxel_size_m = std::numeric_limits<double>::quiet_NaN(); });
  const auto arrival = server.arrivals.take();
  ASSERT_TRUE(arrival);
  EXPECT_EQ(arrival->problem, Reason::bad_request);
  EXPECT_NE(arrival->text.find("voxel_size_m"), std::string::npos) << arrival->text;
}

TEST(ServerLink, WritersOutsideOneClientPartitionAreNotServed) {
  Server server(105);
  Forger strange(105, "robots/not a name");
  strange.send(sample_request("robot1"));
  EXPECT_FALSE(server.arrivals.take(300ms));
  EXPECT_EQ(server.link->clients(), 0U);
}

TEST(ServerLink, ClientsComeAndGo) {
  Server server(106);
  {
    Client client(106, "robot1");
    EXPECT_EQ(server.joins.take(), "robot1");
    EXPECT_EQ(client.server.take(), true);
    EXPECT_EQ(server.link->clients(), 1U);
  }
  EXPECT_EQ(server.leaves.take(), "robot1");
  EXPECT_EQ(server.gone, 1);
  EXPECT_EQ(server.link->clients(), 0U);
  EXPECT_FALSE(server.link->reply({"robot1", 0, 0}, sample_reply()));
}

TEST(ServerLink, NoMoreClientsThanTheLimitAreServed) {
  Server server(109, 1);
  auto first = std::make_unique<Client>(109, "robot1");
  ASSERT_TRUE(eventually([&] { return first->link->server_matched(); }));
  Client second(109, "robot2");
  std::this_thread::sleep_for(200ms);
  EXPECT_FALSE(second.link->server_matched());
  EXPECT_EQ(server.link->clients(), 1U);
  first.reset();  // makes room
  EXPECT_TRUE(eventually([&] { return second.link->server_matched(); }));
}

}  // namespace
}  // namespace liloc::wire
