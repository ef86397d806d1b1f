#pragma once
// What the tests of the C API share.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "client/include/liloc/client.h"
#include "common/testing/within.hpp"

namespace liloc::test {

constexpr int kDomain = 176, kAnsweredDomain = 177;  // of these tests alone
constexpr int kWidth = 32, kHeight = 24;

inline liloc_client_options good_options() {
  liloc_client_options o;
  EXPECT_EQ(liloc_client_options_init(&o, sizeof o), LILOC_OK);
  o.id = "c-api";
  o.domain = kDomain;
  o.camera = {kWidth, kHeight, 24, 24, 15.5, 11.5, 0.001};
  return o;
}

inline std::string error() {
  return liloc_client_last_error();
}

struct Destroy {
  void operator()(liloc_client* client) const { EXPECT_EQ(liloc_client_destroy(client), LILOC_OK) << error(); }
};
using Handle = std::unique_ptr<liloc_client, Destroy>;

inline Handle created(const liloc_client_options& options = good_options()) {
  liloc_client* client = nullptr;
  EXPECT_EQ(liloc_client_create(&options, sizeof options, &client), LILOC_OK) << error();
  return Handle(client);
}

inline liloc_status push(liloc_client* client, std::int64_t stamp_ns, std::uint16_t units = 2000) {
  const std::vector<std::uint16_t> image(kWidth * kHeight, units);
  return liloc_client_push_depth(client, image.data(), kWidth, kHeight, stamp_ns);
}

}  // namespace liloc::test
