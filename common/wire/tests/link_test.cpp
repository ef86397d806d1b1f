#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <deque>
#include <thread>

#include "common/base/log.hpp"
#include "common/wire/client_link.hpp"
#include "common/wire/convert.hpp"
#include "common/wire/convert_spot.hpp"
#include "common/wire/namesake.hpp"
#include "common/wire/server_link.hpp"
#include "common/wire/topics.hpp"
#include "common/wire/typed.hpp"
#include "samples.hpp"

namespace liloc::wire {
namespace {

using namespace std::chrono_literals;

template <class T>
class Inbox {
 public:
  void put(T item) {
    const std::scoped_lock lock(mutex_);
    items_.push_back(std::move(item));
    ready_.notify_all();
  }
  std::optional<T> take(std::chrono::milliseconds wait = 5s) {
    std::unique_lock lock(mutex_);
    if (!ready_.wait_for(lock, wait, [&] { return !items_.empty(); })) return std::nullopt;
    T item = std::move(items_.front());
    items_.pop_front();
    return item;
  }

 private:
  std::mutex mutex_;
  std::condition_variable ready_;
  std::deque<T> items_;
};

bool eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 500; ++i, std::this_thread::sleep_for(10ms))
    if (holds()) return true;
  return false;
}

// A server that hands its arrivals to the test; members in the order of their making.
struct Server {
  explicit Server(int domain, std::size_t max_clients = 512)
      : seat(Participant::create({.domain = domain, .role = Role::server}).value()),
        dispatcher(Dispatcher::create(seat).value()),
        link(ServerLink::create(*dispatcher, {.server_id = "edge1", .max_clients = max_clients},
                                {.on_request = [this](Arrival a) { arrivals.put(std::move(a)); },
                                 .on_join = [this](const std::string& id) { joins.put(id); },
                                 .on_leave = [this](const std::string& id) { leaves.put(id); },
                                 .on_gone = [this](std::uint64_t) { ++gone; }})
                 .value()) {
    dispatcher->start();
  }
  ~Server() { dispatcher->stop(); }

  Inbox<Arrival> arrivals;
  Inbox<std::string> joins, leaves;
  std::atomic<int> gone = 0;
  Participant seat;
  std::unique_ptr<Dispatcher> dispatcher;
  std::unique_ptr<ServerLink> link;
};

struct Client {
  Client(int domain, const std::string& id)
      : seat(Participant::create({.domain = domain}).value()),
        dispatcher(Dispatcher::create(seat).value()),
        link(ClientLink::create(*dispatcher, id,
                                {.on_reply = [this](SpotReply r) { replies.put(std::move(r)); },
                                 .on_server = [this](bool matched) { server.put(matched); },
                                 .on_server_found = [this] { ++found; },
                                 .on_bad_reply = {}})
                 .value()) {
    dispatcher->start();
  }
  ~Client() { dispatcher->stop(); }

  Inbox<SpotReply> replies;
  Inbox<bool> server;
  std::atomic<int> found = 0;
  Participant seat;
  std::unique_ptr<Dispatcher> dispatcher;
  std::unique_ptr<ClientLink> link;
};

// A writer that says what it likes: for identities and versions that our client would never send.
struct Forger {
  Forger(int domain, const std::string& partition) : seat(Participant::create({.domain = domain}).value()) {
    publisher =
        checked(dds_create_publisher(seat.handle(), partition_qos(partition).get(), nullptr), "p").value();
    writer =
        make_writer<liloc_msg_SpotRequest>(seat.handle(), publisher.handle(), kRequestTopic, reliable_qos(8))
            .value();
  }
  void send(const SpotRequest& request, const std::function<void(liloc_msg_SpotRequest&)>& forge = {}) const {
    auto sample = to_wire(request, 1).value();
    if (forge) forge(sample.message);
    ASSERT_TRUE(eventually([this] {
      dds_publication_matched_status_t status{};
      return dds_get_publication_matched_status(writer.handle(), &status) == 0 && status.current_count > 0;
    }));
    ASSERT_TRUE(check(dds_write(writer.handle(), &sample.message), "write"));
  }
  Participant seat;
  Entity publisher, writer;
};

TEST(Link, ACallbackThatThrowsTakesNothingWithIt) {
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

TEST(Link, ARequestIsAnsweredWithAllItsFields) {
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

TEST(Link, AClientThatClaimsAnotherIdIsNamedByItsPartition) {
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

TEST(Link, AForgedNameReachesNoTextAsItIs) {
  Server server(115);
  Forger forger(115, "robots/mallory");
  forger.send(sample_request(), [](auto& m) { copy_text(m.client_id, "a\x1b[2J\nforged"); });
  const auto arrival = server.arrivals.take();
  ASSERT_TRUE(arrival);
  EXPECT_EQ(arrival->problem, Reason::identity);
  EXPECT_EQ(arrival->text, "client_id is a?[2J forged, the sender is mallory");
}

TEST(Link, StrangersByTheDozenAreOneLine) {
  Lines lines;
  Server server(116);
  std::vector<std::unique_ptr<Forger>> strange;
  for (int i = 0; i < 12; ++i)
    strange.push_back(std::make_unique<Forger>(116, "robots/no name " + std::to_string(i)));
  ASSERT_TRUE(eventually([&] { return lines.with("is not in one partition") > 0; }));
  std::this_thread::sleep_for(1s);
  EXPECT_EQ(lines.with("is not in one partition"), 1U);
}

TEST(Link, AnotherProtocolVersionIsReported) {
  Server server(103);
  Forger forger(103, "robots/old");
  forger.send(sample_request("old"), [](auto& message) { message.protocol_version = kProtocolVersion + 1; });
  const auto arrival = server.arrivals.take();
  ASSERT_TRUE(arrival);
  EXPECT_EQ(arrival->problem, Reason::protocol_version) << arrival->text;
  EXPECT_EQ(arrival->request.seq, 7U);
}

TEST(Link, AMalformedRequestIsReportedByField) {
  Server server(104);
  Forger forger(104, "robots/bad");
  forger.send(sample_request("bad"),
              [](auto& message) { message.voxel_size_m = std::numeric_limits<double>::quiet_NaN(); });
  const auto arrival = server.arrivals.take();
  ASSERT_TRUE(arrival);
  EXPECT_EQ(arrival->problem, Reason::bad_request);
  EXPECT_NE(arrival->text.find("voxel_size_m"), std::string::npos) << arrival->text;
}

TEST(Link, WritersOutsideOneClientPartitionAreNotServed) {
  Server server(105);
  Forger strange(105, "robots/not a name");
  strange.send(sample_request("robot1"));
  EXPECT_FALSE(server.arrivals.take(300ms));
  EXPECT_EQ(server.link->clients(), 0U);
}

TEST(Link, ClientsComeAndGo) {
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

TEST(Link, AClientSeesTheServerComeAndGo) {
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

TEST(Link, AServerThatBeganAnewIsFoundAgain) {
  Client client(107, "robot1");
  for (const int times : {1, 2}) {
    const Server server(107);
    EXPECT_TRUE(eventually([&] { return client.found == times; }));
  }
}

TEST(Link, AnAnnouncementChangesNothingElse) {
  Server server(107);
  Client client(107, "robot1");
  ASSERT_TRUE(eventually([&] { return client.found == 1; }));
  for (int i = 0; i < 20; ++i) client.link->announce();
  ASSERT_TRUE(client.link->send(sample_request("robot1")));
  EXPECT_TRUE(server.arrivals.take());
  EXPECT_EQ(client.found, 1);
}

TEST(Link, ARestartedClientDoesNotHearTheRepliesToItsEarlierRun) {
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

TEST(Namesake, LivesWhenItGoesOnAskingAfterWhatWasLeft) {
  Namesake namesake;
  const auto start = Namesake::Time{} + 1h;
  for (std::uint64_t seq = 1; seq <= 8; ++seq)
    EXPECT_FALSE(namesake.lives(77, seq, start + 10ms));  // kept ones
  EXPECT_FALSE(namesake.lives(77, 8, start + 5s)) << "the same answer again, from a standby";
  EXPECT_TRUE(namesake.lives(77, 9, start + 6s));
  EXPECT_FALSE(namesake.lives(78, 10, start + 7s)) << "another run that may have ended";
  EXPECT_TRUE(namesake.lives(78, 11, start + 10s));
}

TEST(Namesake, LivesAmongSeveral) {
  Namesake namesake;
  const auto start = Namesake::Time{} + 1h;
  int told = 0;
  for (std::uint64_t seq = 1; seq <= 10; ++seq)
    for (const std::uint64_t session : {77U, 78U})
      told += namesake.lives(session, seq, start + seq * 1s) ? 1 : 0;
  EXPECT_EQ(told, 14) << "from the fourth answer of each on";
}

TEST(Link, TwoDevicesOfOneIdAreToldToBoth) {
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

TEST(Link, NoMoreClientsThanTheLimitAreServed) {
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

TEST(Link, RequestsThatCannotTravelAreRefusedByTheSender) {
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
