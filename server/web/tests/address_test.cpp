#include "server/web/address.hpp"

#include <gtest/gtest.h>

namespace liloc::web {
namespace {

TEST(Address, IsAPortOrAnAddressWithOne) {
  EXPECT_EQ(address_from("9464").value(), (Address{"127.0.0.1", 9464}));
  EXPECT_EQ(address_from("0.0.0.0:80").value(), (Address{"0.0.0.0", 80}));
  EXPECT_EQ(address_from("[::]:9464").value(), (Address{"::", 9464}));
  for (const char* wrong : {"", "0", "65536", "94s", "9464,80", "localhost:80", ":80", "::1:80",
                            "[127.0.0.1]:80", "1.2.3.4:", "[]:80", "0.0.0.0:80s"})
    EXPECT_FALSE(address_from(wrong)) << wrong;
}

TEST(Address, ItsTextIsReadBackAsItself) {
  for (const char* text : {"127.0.0.1:9464", "[::1]:80"}) EXPECT_EQ(text_of(address_from(text).value()), text);
}

TEST(Address, OnlyLoopbackIsOutOfOthersReach) {
  for (const char* host : {"127.0.0.1", "127.9.8.7", "::1"}) EXPECT_TRUE(is_loopback({host, 80})) << host;
  for (const char* host : {"0.0.0.0", "::", "128.0.0.1", "10.0.0.7", "::ffff:127.0.0.1", "localhost", ""})
    EXPECT_FALSE(is_loopback({host, 80})) << host;
}

}  // namespace
}  // namespace liloc::web
