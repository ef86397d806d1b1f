#include "common/wire/spots/status.hpp"

#include <gtest/gtest.h>

#include "common/wire/spots/tests/ends.hpp"

namespace liloc::wire {
namespace {

using namespace std::chrono_literals;
constexpr int kDomain = 118;  // of this test alone

TEST(Status, WhatAServerToldBeforeSomebodyAskedIsHeardOnce) {
  const Participant server = Participant::create({.domain = kDomain, .role = Role::server}).value();
  const auto publisher = StatusPublisher::create(server).value();
  ASSERT_TRUE(publisher.publish(sample_status()));
  const Participant seat = Participant::create({.domain = kDomain}).value();
  const auto dispatcher = Dispatcher::create(seat).value();
  Inbox<Result<ServerStatus>> heard;
  ASSERT_TRUE(
      subscribe_status(*dispatcher, [&](Result<ServerStatus> status) { heard.put(std::move(status)); }));
  dispatcher->start();
  const auto status = heard.take();
  ASSERT_TRUE(status && *status);
  EXPECT_EQ((*status)->server_id, sample_status().server_id);
  EXPECT_EQ((*status)->answered, sample_status().answered);
  ASSERT_EQ((*status)->lidars.size(), 1U);
  EXPECT_EQ((*status)->lidars[0].state, LidarState::slow);
  EXPECT_FALSE(heard.take(100ms));
  dispatcher->stop();
}

TEST(Status, OfMoreLidarsThanTravelTheFirstDo) {
  const Participant server = Participant::create({.domain = kDomain, .role = Role::server}).value();
  const auto publisher = StatusPublisher::create(server).value();
  const auto dispatcher = Dispatcher::create(server).value();
  Inbox<Result<ServerStatus>> heard;
  ASSERT_TRUE(
      subscribe_status(*dispatcher, [&](Result<ServerStatus> status) { heard.put(std::move(status)); }));
  dispatcher->start();
  ServerStatus status = sample_status();
  status.lidars.assign(100, status.lidars[0]);
  ASSERT_TRUE(publisher.publish(status));
  const auto back = heard.take();
  ASSERT_TRUE(back && *back);
  EXPECT_EQ((*back)->lidars.size(), 64U);
  dispatcher->stop();
}

TEST(LidarState, EachHasItsNameAndSlowFramesCount) {
  EXPECT_EQ(name_of(LidarState::clock_off), "clock_off");
  EXPECT_EQ(name_of(static_cast<LidarState>(99)), "unknown");
  EXPECT_TRUE(is_heard(LidarState::slow));
  EXPECT_FALSE(is_heard(LidarState::blind));
}

}  // namespace
}  // namespace liloc::wire
