#include "proto-tests/soak/options.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace liloc::soak {
namespace {

using testing::HasSubstr;

TEST(SoakOptions, DefaultsAreValid) {
  EXPECT_TRUE(SoakOptions{}.validated());
}

TEST(SoakOptions, ErrorsNameTheOptionAndItsRange) {
  const auto error_of = [](const auto& set) {
    SoakOptions options;
    set(options);
    const Status valid = options.validated();
    return valid ? "no error" : valid.error().message;
  };
  EXPECT_THAT(error_of([](auto& o) { o.seconds = 29; }), HasSubstr("--seconds is 29, must be 30..604800"));
  EXPECT_THAT(error_of([](auto& o) { o.seconds = std::nan(""); }), HasSubstr("--seconds"));
  EXPECT_THAT(error_of([](auto& o) { o.visitors = 0; }), HasSubstr("--visitors is 0, must be 1..64"));
  EXPECT_THAT(error_of([](auto& o) { o.restart_s = 3; }), HasSubstr("--restart is 3, must be 0 or 15..3600"));
  EXPECT_EQ(error_of([](auto& o) { o.flap_s = o.restart_s = 0; }), "no error");
}

TEST(SoakOptions, AQuarterIsWarmUpWithinBounds) {
  SoakOptions options;
  options.seconds = 30;
  EXPECT_EQ(options.warmup_s(), 15);
  options.seconds = 200;
  EXPECT_EQ(options.warmup_s(), 50);
  options.seconds = 36'000;
  EXPECT_EQ(options.warmup_s(), 120);
}

}  // namespace
}  // namespace liloc::soak
