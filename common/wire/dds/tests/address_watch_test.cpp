#include "common/wire/dds/address_watch.hpp"

#include <gmock/gmock.h>

namespace liloc::wire {
namespace {

using Set = std::set<std::string>;

constexpr bool kReached = true;
const Set kRadio{"10.0.0.4"}, kElsewhere{"10.0.0.9"}, kBridge{"172.17.0.1"}, kBoth{"10.0.0.4", "172.17.0.1"};

/// An interface whose addresses a test sets.
struct Interface {
  explicit Interface(Set at_join) : now(std::move(at_join)) {}
  Set now;
  AddressWatch watch{[this] { return now; }};
  [[nodiscard]] bool changed(const Set& to, bool reached = kReached) {
    now = to;
    return watch.changed(reached);
  }
};

TEST(AddressWatch, TellsOnceThatAnAddressWasReplaced) {
  for (const bool reached : {true, false}) {
    Interface radio(kRadio);
    EXPECT_FALSE(radio.changed(kRadio, reached));
    EXPECT_TRUE(radio.changed(kElsewhere, reached));
    EXPECT_FALSE(radio.changed(kElsewhere, reached));
  }
}

TEST(AddressWatch, WaitsUntilThereIsAnotherAndForgivesTheSame) {
  Interface radio(kRadio);
  EXPECT_FALSE(radio.changed({}));
  EXPECT_FALSE(radio.changed(kRadio)) << "a cable was pulled and plugged in again";
  EXPECT_FALSE(radio.changed({}));
  EXPECT_TRUE(radio.changed(kElsewhere));
}

TEST(AddressWatch, ASecondInterfaceThatComesAndGoesWasNeverUsed) {
  Interface automatic(kRadio);
  EXPECT_FALSE(automatic.changed(kBoth));
  EXPECT_FALSE(automatic.changed(kRadio));
  EXPECT_FALSE(automatic.changed(kBoth));
  EXPECT_TRUE(automatic.changed({"10.0.0.9", "172.17.0.1"})) << "the first is replaced";
}

TEST(AddressWatch, OneOfTwoThatWereThereIsMissed) {
  Interface automatic(kBoth);
  EXPECT_TRUE(automatic.changed(kRadio)) << "nobody knows which of them DDS uses";
  EXPECT_FALSE(automatic.changed(kRadio));
}

TEST(AddressWatch, WithoutAServerItJoinsOverWhatComes) {
  Interface automatic(kBridge);
  EXPECT_FALSE(automatic.changed(kBoth, kReached));
  EXPECT_TRUE(automatic.changed(kBoth, !kReached));
  EXPECT_FALSE(automatic.changed(kBoth, !kReached)) << "once";
  Interface none({});  // DDS has taken the loopback, which is no address of "auto"
  EXPECT_FALSE(none.changed({}, !kReached));
  EXPECT_TRUE(none.changed(kRadio, !kReached));
}

TEST(AddressWatch, ARadioThatRoamsBesideABridgeIsFollowedBack) {
  Interface automatic(kBoth);
  EXPECT_TRUE(automatic.changed(kBridge)) << "between two networks only the bridge is there";
  EXPECT_TRUE(automatic.changed({"10.0.0.9", "172.17.0.1"}, !kReached));
  EXPECT_FALSE(automatic.changed({"10.0.0.9", "172.17.0.1"}, !kReached));
}

TEST(Addresses, OfTheLoopbackByNameAndByAddressAndNeverByAuto) {
  EXPECT_THAT(addresses_of("lo"), testing::Contains("127.0.0.1"));
  EXPECT_EQ(addresses_of("127.0.0.1"), Set{"127.0.0.1"});
  EXPECT_THAT(addresses_of("auto"), testing::Not(testing::Contains("127.0.0.1")));
  EXPECT_TRUE(addresses_of("no-such-interface").empty());
}

}  // namespace
}  // namespace liloc::wire
