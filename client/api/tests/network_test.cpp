#include "client/api/network.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "client/api/tests/by_heart_server.hpp"
#include "common/base/log.hpp"
#include "common/recording/tests/temporary_folder.hpp"
#include "common/testing/within.hpp"

namespace liloc::client {
namespace {

using namespace std::chrono_literals;
using test::within;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr int kDomain = 137;  // of this test alone

/// A client's network on the loopback, with the addresses that a test gives it.
class Roaming : public testing::Test {
 protected:
  Roaming() {
    log::set_sink([this](log::Level level, std::string_view line) {
      const std::scoped_lock lock(mutex_);
      if (level >= log::Level::warning && line.starts_with("robot1")) lines_.emplace_back(line);
    });
  }
  void TearDown() override {
    network_.reset();
    log::set_sink({});
  }
  void join() {
    Network::Callbacks callbacks;
    callbacks.link.on_server = [this](bool matched) { matched_ = matched; };
    callbacks.link.on_reply = [this](const SpotReply& reply) { answered_ = reply.seq; };
    callbacks.look = [this] { ++looks_; };
    auto joined = Network::join({.domain = kDomain}, "robot1", std::move(callbacks), [this] {
      const std::scoped_lock lock(mutex_);
      return std::set<std::string>{address_};
    });
    ASSERT_TRUE(joined) << joined.error().message;
    network_ = std::move(*joined);
    network_->start();
  }
  void roam() {
    const std::scoped_lock lock(mutex_);
    address_ += "0";
  }
  [[nodiscard]] bool is_answered(std::uint64_t seq) {
    SpotRequest request;
    request.client_id = "robot1";
    request.seq = seq;
    request.stamp_ns = static_cast<StampNs>(seq) * 1'000'000;
    return within(20s, [&] {
      (void)network_->send(request);
      return within(100ms, [&] { return answered_ == seq; });
    });
  }
  [[nodiscard]] std::vector<std::string> lines() {
    const std::scoped_lock lock(mutex_);
    return lines_;
  }

  std::mutex mutex_;
  std::string address_ = "10.0.0.4";
  std::vector<std::string> lines_;
  std::atomic<bool> matched_ = false;
  std::atomic<std::uint64_t> answered_ = 0;
  std::atomic<int> looks_ = 0;
  std::unique_ptr<Network> network_;
};

/// A server of this process would hold the domain.
TEST_F(Roaming, JoinsAnewWhereItsAddressIsReplaced) {
  join();
  EXPECT_TRUE(within(20s, [&] { return looks_ >= 2; }));
  EXPECT_THAT(lines(), IsEmpty());
  roam();
  EXPECT_TRUE(within(20s, [&] { return !lines().empty(); }));
  const int before = looks_;
  EXPECT_TRUE(within(20s, [&] { return looks_ > before; }));
  EXPECT_THAT(lines(), ElementsAre(HasSubstr("the address on lo has changed: joining the network anew")));
  EXPECT_FALSE(matched_);
}

TEST_F(Roaming, WhoKeepsTheDomainIsToldOnceAndServedOn) {
  const auto server = test::ByHeartServer::start(kDomain);
  ASSERT_TRUE(server) << server.error().message;
  join();
  EXPECT_TRUE(is_answered(1));
  EXPECT_TRUE(within(20s, [&] { return matched_.load(); }));
  for (std::uint64_t seq = 2; seq < 4; ++seq) {
    roam();
    EXPECT_TRUE(within(20s, [&] { return lines().size() >= seq; }));
    EXPECT_TRUE(is_answered(seq));
  }
  EXPECT_THAT(lines(), ElementsAre(HasSubstr("joining the network anew"),
                                   HasSubstr("other DDS participants of this process keep domain 137"),
                                   HasSubstr("joining the network anew")));
}

/// DDS's configuration is a file here, which a test breaks.
TEST_F(Roaming, WhileItCannotJoinItLooksOnAndTriesAgain) {
  const TemporaryFolder folder;
  const std::string good = wire::profile_xml({.domain = kDomain}).value();
  const auto file = folder.put("cyclonedds.xml", good);
  setenv("CYCLONEDDS_URI", ("file://" + file.string()).c_str(), 1);
  join();
  folder.put("cyclonedds.xml", "<CycloneDDS><Nonsense/></CycloneDDS>");
  roam();
  EXPECT_TRUE(within(20s, [&] { return lines().size() >= 2; }));
  EXPECT_THAT(lines().back(), HasSubstr("it is tried again"));
  const int before = looks_;
  EXPECT_TRUE(within(20s, [&] { return looks_ >= before + 3; })) << "nobody watches";
  EXPECT_THAT(lines().back(), HasSubstr("it is tried again")) << "told once";
  SpotRequest request;
  request.client_id = "robot1";
  EXPECT_THAT(network_->send(request).error().message, HasSubstr("not on the network"));
  folder.put("cyclonedds.xml", good);
  EXPECT_TRUE(within(20s, [&] {
    const Status sent = network_->send(request);
    return sent || sent.error().message.find("not on the network") == std::string::npos;
  })) << "it is back, though no server is there";
  network_.reset();
  unsetenv("CYCLONEDDS_URI");
}

}  // namespace
}  // namespace liloc::client
