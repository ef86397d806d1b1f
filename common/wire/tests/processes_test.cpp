// Server and client in two processes, as in the field: discovery by the star's ports and UDP on loopback.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "common/wire/sensors/sensor_publishers.hpp"
#include "common/wire/sensors/sensors.hpp"
#include "common/wire/spots/client_link.hpp"
#include "common/wire/spots/server_link.hpp"
#include "common/wire/spots/tests/samples.hpp"

namespace liloc::wire {
namespace {

using namespace std::chrono_literals;
constexpr int kDomain = 113;
constexpr Camera kCamera{320, 240, 228, 228, 160, 120, 0.001};

bool eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 1000; ++i, std::this_thread::sleep_for(10ms))
    if (holds()) return true;
  return false;
}

/// Answers every request, with the count of ceiling images so far as its margin, until it is killed.
[[noreturn]] void serve() {
  const auto seat = Participant::create({.domain = kDomain, .role = Role::server});
  if (!seat) _exit(3);
  auto dispatcher = Dispatcher::create(*seat).value();
  std::unique_ptr<ServerLink> link;
  double images = 0;
  link = ServerLink::create(*dispatcher, {}, {.on_request = [&](Arrival arrival) {
           SpotReply reply = sample_reply(arrival.request);
           reply.margin = images;
           if (!link->reply(arrival.from, std::move(reply))) _exit(4);
         }}).value();
  if (!subscribe_depth(*dispatcher, "ceiling0", 0.001, [&](const auto& image) { images += image ? 1 : 1e6; }))
    _exit(5);
  dispatcher->start();
  for (;;) pause();
}

/// Forks before this process has any thread of DDS.
class ServerProcess {
 public:
  ServerProcess() : pid_(fork()) {
    if (pid_ == 0) serve();
  }
  ~ServerProcess() { end(); }
  void end() {
    if (pid_ > 0) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    pid_ = 0;
  }

 private:
  pid_t pid_;
};

TEST(Processes, RequestsStreamsAndRepliesCross) {
  ServerProcess server;
  const auto seat = Participant::create({.domain = kDomain});
  ASSERT_TRUE(seat) << seat.error().message;
  auto dispatcher = Dispatcher::create(*seat).value();
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<SpotReply> replies;
  const auto link = ClientLink::create(*dispatcher, "robot1", {.on_reply = [&](SpotReply reply) {
    const std::scoped_lock lock(mutex);
    replies.push_back(std::move(reply));
    changed.notify_all();
  }});
  ASSERT_TRUE(link);
  const auto ceiling = DepthPublisher::create(*seat, "ceiling0", kCamera);
  ASSERT_TRUE(ceiling);
  dispatcher->start();
  ASSERT_TRUE(eventually([&] { return (*link)->server_matched() && ceiling->readers() == 1; }));

  constexpr std::uint64_t kRequests = 30;
  DepthImage image{0, kCamera.width, kCamera.height, {}};
  image.units.assign(320 * 240, 1500);
  std::vector<double> round_trip_ms;
  for (std::uint64_t seq = 1; seq <= kRequests; ++seq) {
    image.stamp_ns = static_cast<StampNs>(seq);
    ASSERT_TRUE(ceiling->publish(image));
    SpotRequest request = sample_request("robot1", seq);
    request.lpc.bytes.assign(10'000, 7);
    const Stopwatch watch;
    ASSERT_TRUE((*link)->send(request));
    std::unique_lock lock(mutex);
    ASSERT_TRUE(changed.wait_for(lock, 5s, [&] { return replies.size() >= seq; })) << "request " << seq;
    round_trip_ms.push_back(watch.elapsed_ms());
    EXPECT_EQ(replies.back().seq, seq);
    EXPECT_TRUE(replies.back().verified());
    lock.unlock();
    std::this_thread::sleep_for(30ms);  // the pace of a LiDAR: streams keep the newest five frames
  }
  std::ranges::sort(round_trip_ms);
  RecordProperty("round_trip_p50_us", static_cast<int>(1e3 * round_trip_ms[kRequests / 2]));
  EXPECT_LT(round_trip_ms[kRequests / 2], 100);
  EXPECT_GE(replies.back().margin, 0.9 * static_cast<double>(kRequests)) << "images that crossed";
  EXPECT_LE(replies.back().margin, static_cast<double>(kRequests)) << "or one was malformed";
  dispatcher->stop();
}

}  // namespace
}  // namespace liloc::wire
