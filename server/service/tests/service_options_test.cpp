#include "server/service/service_options.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace liloc {
namespace {

TEST(ServiceOptions, OptionsOutOfRangeAreNamed) {
  for (const auto& [options, field] : {std::pair{ServiceOptions{.workers = 0}, "workers"},
                                       {ServiceOptions{.queue = 0}, "queue"},
                                       {ServiceOptions{.max_rate_hz = 0}, "max_rate_hz"},
                                       {ServiceOptions{.max_clients = 0}, "max_clients"},
                                       {ServiceOptions{.server_id = "no blanks"}, "server_id"}}) {
    const auto valid = options.validated();
    ASSERT_FALSE(valid) << field;
    EXPECT_NE(valid.error().message.find(field), std::string::npos) << valid.error().message;
  }
}

}  // namespace
}  // namespace liloc
