#include "common/wire/dds/participant.hpp"

#include <gtest/gtest.h>

namespace liloc::wire {
namespace {

bool has(const std::string& xml, std::string_view part) {
  return xml.find(part) != std::string::npos;
}

TEST(Profile, TheServerSitsOnTheFirstPortAndNamesNoPeer) {
  const auto xml = profile_xml({.domain = 3, .role = Role::server});
  ASSERT_TRUE(xml);
  EXPECT_TRUE(has(*xml, "<ParticipantIndex>0<"));
  EXPECT_FALSE(has(*xml, "Peer"));
  EXPECT_TRUE(has(*xml, R"(name="lo")"));
  EXPECT_TRUE(has(*xml, "<AllowMulticast>false<"));
}

TEST(Profile, AStandbySitsOnTheThirdPortAndNamesNoPeer) {
  const auto xml = profile_xml({.domain = 3, .role = Role::standby});
  ASSERT_TRUE(xml);
  EXPECT_TRUE(has(*xml, "<ParticipantIndex>2<"));
  EXPECT_FALSE(has(*xml, "Peer"));
}

TEST(Profile, AClientKnowsTheServersAndTheSourcesPort) {
  const auto xml = profile_xml({.domain = 2, .peers = {"10.0.0.7"}});
  ASSERT_TRUE(xml);
  EXPECT_TRUE(has(*xml, "<ParticipantIndex>none<"));
  EXPECT_TRUE(has(*xml, R"("10.0.0.7:7910")"));
  EXPECT_TRUE(has(*xml, R"("10.0.0.7:7912")"));
  EXPECT_TRUE(has(*xml, R"("10.0.0.7:7914")"));
}

TEST(Profile, LargeDatagramsAreForLoopbackAlone) {
  EXPECT_TRUE(has(*profile_xml({}), "65500B"));
  EXPECT_FALSE(has(*profile_xml({.interface = "eth0"}), "65500B"));
  EXPECT_TRUE(has(*profile_xml({.interface = "10.1.2.3"}), R"(address="10.1.2.3")"));
  EXPECT_TRUE(has(*profile_xml({.interface = "auto"}), R"(autodetermine="true")"));
}

TEST(Profile, ADevicesDatagramsFitAFrameOfEthernet) {
  EXPECT_TRUE(has(*profile_xml({.interface = "wlan0"}), "<MaxMessageSize>1472B<"));
  EXPECT_FALSE(has(*profile_xml({.role = Role::server, .interface = "eth0"}), "MaxMessageSize"));
  EXPECT_FALSE(has(*profile_xml({.role = Role::source, .interface = "eth0"}), "MaxMessageSize"));
}

TEST(Profile, ADeviceThatRoamsCanEndItsParticipant) {
  EXPECT_TRUE(has(*profile_xml({}), "<MultipleReceiveThreads>false<"));
  EXPECT_FALSE(has(*profile_xml({.role = Role::server}), "MultipleReceiveThreads"));
}

TEST(Profile, SourcesTellThatTheyAreThereMoreOften) {
  EXPECT_TRUE(has(*profile_xml({}), "<SPDPInterval>1s<"));
  EXPECT_TRUE(has(*profile_xml({.role = Role::source}), "<SPDPInterval>200ms<"));
}

TEST(Profile, WhatIsNoNameOrAddressIsRefused) {
  EXPECT_FALSE(profile_xml({.domain = -1}));
  EXPECT_FALSE(profile_xml({.domain = 231}));
  EXPECT_FALSE(profile_xml({.interface = R"(lo"/><x)"}));
  EXPECT_FALSE(profile_xml({.interface = ""}));
  EXPECT_FALSE(profile_xml({.peers = {"a b"}}));
  EXPECT_FALSE(profile_xml({.receive_buffer_kb = 1}));
}

TEST(Participant, OneServerSitsInADomainOfAHost) {
  constexpr int kDomain = 123;  // of this test alone
  const auto first = Participant::create({.domain = kDomain, .role = Role::server});
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_EQ(first->domain(), kDomain);
  EXPECT_GT(first->handle(), 0);
  EXPECT_EQ(server_port(2), 7910) << "as the profile of domain 2 names it";
}

TEST(Participant, WhatCannotJoinIsRefusedBeforeDdsIsAsked) {
  EXPECT_NE(Participant::create({.domain = 231}).error().message.find("domain"), std::string::npos);
  const auto locked = Participant::create({.domain = 123, .credentials = "/no/such/folder"});
  ASSERT_FALSE(locked);
  EXPECT_NE(locked.error().message.find("/no/such/folder"), std::string::npos) << locked.error().message;
}

TEST(Profile, ABufferTheKernelDoesNotAllowIsLoweredNotFatal) {
  const auto participant = Participant::create({.domain = 111, .receive_buffer_kb = 1'048'576});
  EXPECT_TRUE(participant) << participant.error().message;
}

}  // namespace
}  // namespace liloc::wire
