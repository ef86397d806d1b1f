// Datagrams between hosts of our own: all arrive in fair weather, and in foul weather what was asked for
// happens.
#include "proto-tests/faults/bad_network.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

namespace liloc::faults {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint16_t kPort = 4000;

sockaddr_in at(const std::string& address) {
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(kPort);
  inet_pton(AF_INET, address.c_str(), &place.sin_addr);
  return place;
}

/// A socket of a host, bound to our port.
class Post {
 public:
  explicit Post(NetworkHost& host) {
    host.within([this] {
      handle_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
      const sockaddr_in any = at("0.0.0.0");
      EXPECT_EQ(bind(handle_, reinterpret_cast<const sockaddr*>(&any), sizeof any), 0) << std::strerror(errno);
      const timeval limit{.tv_sec = 0, .tv_usec = 600'000};
      setsockopt(handle_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    });
  }
  ~Post() { close(handle_); }
  Post(const Post&) = delete;
  Post& operator=(const Post&) = delete;

  void send(const std::string& to, int number) const {
    const sockaddr_in place = at(to);
    sendto(handle_, &number, sizeof number, 0, reinterpret_cast<const sockaddr*>(&place), sizeof place);
  }
  /// All that comes until nothing does for a while.
  [[nodiscard]] std::vector<int> receive() const {
    std::vector<int> numbers;
    for (int number = 0; recv(handle_, &number, sizeof number, 0) == sizeof number;) numbers.push_back(number);
    return numbers;
  }

 private:
  int handle_ = -1;
};

class Network : public testing::Test {
 protected:
  void SetUp() override {
    if (const Status may = permitted(); !may) GTEST_SKIP() << may.error().message;
    const Status entered = enter_own_namespaces();
    ASSERT_TRUE(entered) << entered.error().message;
    auto made = BadNetwork::create({"a", "b"}, 7);
    ASSERT_TRUE(made) << made.error().message;
    network_ = std::move(*made);
    a_.emplace(network_->host("a"));
    b_.emplace(network_->host("b"));
    a_->send("10.77.0.2", -1);  // who is who is known from here on
    ASSERT_EQ(b_->receive(), std::vector{-1});
  }
  [[nodiscard]] std::vector<int> hundred_to_b() const {
    for (int i = 0; i < 100; ++i) a_->send("10.77.0.2", i);
    return b_->receive();
  }

  std::unique_ptr<BadNetwork> network_;
  std::optional<Post> a_, b_;
};

TEST_F(Network, FairWeatherKeepsAllInOrder) {
  const auto got = hundred_to_b();
  ASSERT_EQ(got.size(), 100u);
  EXPECT_TRUE(std::ranges::is_sorted(got));
}

TEST_F(Network, LosesTheShareThatItIsToldTo) {
  network_->set("b", {.loss = 0.3});
  const auto got = hundred_to_b();
  EXPECT_GT(got.size(), 50u);
  EXPECT_LT(got.size(), 90u);
  EXPECT_GT(network_->counters("b").lost, 9u);
}

TEST_F(Network, DelaysAndReorders) {
  network_->set("a", {.delay_ms = 50, .jitter_ms = 20});
  const auto start = Clock::now();
  a_->send("10.77.0.2", 0);
  while (b_->receive().empty()) ASSERT_LT(Clock::now() - start, std::chrono::seconds(20));
  EXPECT_GE(Clock::now() - start, std::chrono::milliseconds(30));
  const auto got = hundred_to_b();
  ASSERT_EQ(got.size(), 100u);
  EXPECT_FALSE(std::ranges::is_sorted(got));
}

TEST_F(Network, NothingPassesACutLinkUntilItIsMended) {
  network_->set("a", {.cut = true});
  EXPECT_TRUE(hundred_to_b().empty());
  network_->set("a", {});
  EXPECT_EQ(hundred_to_b().size(), 100u);
}

TEST_F(Network, AHostThatRoamsIsFoundAtItsNewAddressAlone) {
  ASSERT_TRUE(network_->host("b").change_address("10.77.0.22"));
  a_->send("10.77.0.22", 5);
  EXPECT_EQ(b_->receive(), std::vector{5});
  a_->send("10.77.0.2", 6);
  EXPECT_TRUE(b_->receive().empty());
}

}  // namespace
}  // namespace liloc::faults
