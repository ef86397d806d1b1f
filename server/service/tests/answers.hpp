#pragma once
// What the tests of the scheduler share: requests, a place for answers, and a localizer that waits for the
// test.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <map>
#include <string>

#include "server/service/request_scheduler.hpp"

namespace liloc::test {

inline wire::Arrival arrival(const std::string& client, std::uint64_t seq, std::uint64_t session = 1) {
  wire::Arrival a;
  a.from = {client, std::hash<std::string>{}(client) + session, session};
  a.request.client_id = client;
  a.request.seq = seq;
  a.request.stamp_ns = static_cast<StampNs>(seq);
  a.at = std::chrono::steady_clock::now();
  return a;
}

// Collects every answer; a count other than one for any request is a fault of the scheduler.
class Answers {
 public:
  RequestScheduler::Answer sink() {
    return [this](const wire::Sender& to, SpotReply reply) {
      const std::scoped_lock lock(mutex_);
      EXPECT_EQ(to.client_id, reply.client_id);
      EXPECT_GE(reply.latency_ms, 0);
      ++count_[{reply.client_id, reply.seq}];
      replies_[{reply.client_id, reply.seq}] = std::move(reply);
      ++total_;
      changed_.notify_all();
    };
  }
  bool wait_for(std::size_t total) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(10), [&] { return total_ >= total; });
  }
  Reason reason(const std::string& client, std::uint64_t seq) {
    const std::scoped_lock lock(mutex_);
    const auto found = replies_.find({client, seq});
    return found == replies_.end() ? Reason::no_answer : found->second.reason;
  }
  std::size_t count(Reason reason) {
    const std::scoped_lock lock(mutex_);
    return static_cast<std::size_t>(
        std::ranges::count_if(replies_, [&](const auto& r) { return r.second.reason == reason; }));
  }
  void expect_each_once(std::size_t requests) {
    const std::scoped_lock lock(mutex_);
    EXPECT_EQ(count_.size(), requests);
    for (const auto& [key, count] : count_) EXPECT_EQ(count, 1) << key.first << " " << key.second;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::pair<std::string, std::uint64_t>, int> count_;
  std::map<std::pair<std::string, std::uint64_t>, SpotReply> replies_;
  std::size_t total_ = 0;
};

// A localizer that works on one request until the test opens the gate.
class Gate {
 public:
  SpotReply pass(const SpotRequest& request) {
    std::unique_lock lock(mutex_);
    ++inside_;
    changed_.notify_all();
    changed_.wait(lock, [&] { return open_; });
    SpotReply reply = refusal(request, Reason::confirmed, "");
    reply.status = SpotStatus::verified;
    return reply;
  }
  void wait_inside() {
    std::unique_lock lock(mutex_);
    ASSERT_TRUE(changed_.wait_for(lock, std::chrono::seconds(10), [&] { return inside_ > 0; }));
  }
  void open() {
    const std::scoped_lock lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }
  void close() {
    const std::scoped_lock lock(mutex_);
    open_ = false;
    inside_ = 0;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false;
  int inside_ = 0;
};

inline SpotReply verified(const SpotRequest& request) {
  SpotReply reply = refusal(request, Reason::confirmed, "");
  reply.status = SpotStatus::verified;
  return reply;
}

}  // namespace liloc::test
