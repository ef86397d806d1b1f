#include "common/wire/dds/address_watch.hpp"

#include <gmock/gmock.h>

namespace liloc::wire {
namespace {

using Set = std::set<std::string>;

TEST(AddressWatch, TellsOnceThatAnAddressWasReplaced) {
  Set now{"10.0.0.4"};
  AddressWatch watch([&] { return now; });
  EXPECT_FALSE(watch.changed());
  now = {"10.0.0.9"};
  EXPECT_TRUE(watch.changed());
  EXPECT_FALSE(watch.changed());
}

TEST(AddressWatch, WaitsUntilThereIsAnotherAndForgivesTheSame) {
  Set now{"10.0.0.4"};
  AddressWatch watch([&] { return now; });
  now = {};
  EXPECT_FALSE(watch.changed());
  now = {"10.0.0.4"};
  EXPECT_FALSE(watch.changed()) << "a cable was pulled and plugged in again";
  now = {};
  EXPECT_FALSE(watch.changed());
  now = {"10.0.0.5"};
  EXPECT_TRUE(watch.changed());
}

TEST(AddressWatch, OneMoreAddressChangesNothing) {
  Set now{"10.0.0.4"};
  AddressWatch watch([&] { return now; });
  now = {"10.0.0.4", "172.17.0.1"};
  EXPECT_FALSE(watch.changed());
  now = {"10.0.0.4"};
  EXPECT_TRUE(watch.changed()) << "nobody knows which of them DDS uses";
}

TEST(Addresses, OfTheLoopbackByNameAndByAddressAndNeverByAuto) {
  EXPECT_THAT(addresses_of("lo"), testing::Contains("127.0.0.1"));
  EXPECT_EQ(addresses_of("127.0.0.1"), Set{"127.0.0.1"});
  EXPECT_THAT(addresses_of("auto"), testing::Not(testing::Contains("127.0.0.1")));
  EXPECT_TRUE(addresses_of("no-such-interface").empty());
}

}  // namespace
}  // namespace liloc::wire
