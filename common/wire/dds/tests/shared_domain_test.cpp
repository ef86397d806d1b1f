#include "common/wire/dds/shared_domain.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace liloc::wire {
namespace {

TEST(SharedDomain, IsHeldUntilTheLastParticipantHasLeft) {
  constexpr int kDomain = 124;  // of this test alone
  EXPECT_FALSE(domain_is_held(kDomain));
  std::optional<Participant> second;
  {
    const auto first = Participant::create({.domain = kDomain});
    ASSERT_TRUE(first) << first.error().message;
    second = Participant::create({.domain = kDomain}).value();
  }
  EXPECT_TRUE(domain_is_held(kDomain));
  EXPECT_FALSE(domain_is_held(kDomain + 1));
  second.reset();
  EXPECT_FALSE(domain_is_held(kDomain));
}

}  // namespace
}  // namespace liloc::wire
