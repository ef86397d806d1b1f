#pragma once
// A server, a client and a stranger on loopback, for the tests of this room; each test has a domain of its own.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include "common/wire/dds/topics.hpp"
#include "common/wire/dds/typed.hpp"
#include "common/wire/spots/client_link.hpp"
#include "common/wire/spots/convert_spot.hpp"
#include "common/wire/spots/server_link.hpp"
#include "common/wire/spots/tests/samples.hpp"

namespace liloc::wire {

/// What a callback hands to the test's thread.
template <class T>
class Inbox {
 public:
  void put(T item) {
    const std::scoped_lock lock(mutex_);
    items_.push_back(std::move(item));
    ready_.notify_all();
  }
  std::optional<T> take(std::chrono::milliseconds wait = std::chrono::seconds(5)) {
    std::unique_lock lock(mutex_);
    if (!ready_.wait_for(lock, wait, [&] { return !items_.empty(); })) return std::nullopt;
    T item = std::move(items_.front());
    items_.pop_front();
    return item;
  }

 private:
  std::mutex mutex_;
  std::condition_variable ready_;
  std::deque<T> items_;
};

/// Whether it comes to hold within five seconds.
inline bool eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 500; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(10)))
    if (holds()) return true;
  return false;
}

/// A server that hands its arrivals to the test; members in the order of their making.
struct Server {
  explicit Server(int domain, std::size_t max_clients = 512)
      : seat(Participant::create({.domain = domain, .role = Role::server}).value()),
        dispatcher(Dispatcher::create(seat).value()),
        link(ServerLink::create(*dispatcher, {.server_id = "edge1", .max_clients = max_clients},
                                {.on_request = [this](Arrival a) { arrivals.put(std::move(a)); },
                                 .on_join = [this](const std::string& id) { joins.put(id); },
                                 .on_leave = [this](const std::string& id) { leaves.put(id); },
                                 .on_gone = [this](std::uint64_t) { ++gone; }})
                 .value()) {
    dispatcher->start();
  }
  ~Server() { dispatcher->stop(); }

  Inbox<Arrival> arrivals;
  Inbox<std::string> joins, leaves;
  std::atomic<int> gone = 0;
  Participant seat;
  std::unique_ptr<Dispatcher> dispatcher;
  std::unique_ptr<ServerLink> link;
};

struct Client {
  Client(int domain, const std::string& id)
      : seat(Participant::create({.domain = domain}).value()),
        dispatcher(Dispatcher::create(seat).value()),
        link(ClientLink::create(*dispatcher, id,
                                {.on_reply = [this](SpotReply r) { replies.put(std::move(r)); },
                                 .on_server = [this](bool matched) { server.put(matched); },
                                 .on_server_found = [this] { ++found; },
                                 .on_bad_reply = {}})
                 .value()) {
    dispatcher->start();
  }
  ~Client() { dispatcher->stop(); }

  Inbox<SpotReply> replies;
  Inbox<bool> server;
  std::atomic<int> found = 0;
  Participant seat;
  std::unique_ptr<Dispatcher> dispatcher;
  std::unique_ptr<ClientLink> link;
};

/// A writer that says what it likes: for identities and versions that our client would never send.
struct Forger {
  Forger(int domain, const std::string& partition) : seat(Participant::create({.domain = domain}).value()) {
    publisher =
        checked(dds_create_publisher(seat.handle(), partition_qos(partition).get(), nullptr), "p").value();
    writer =
        make_writer<liloc_msg_SpotRequest>(seat.handle(), publisher.handle(), kRequestTopic, reliable_qos(8))
            .value();
  }
  void send(const SpotRequest& request, const std::function<void(liloc_msg_SpotRequest&)>& forge = {}) const {
    auto sample = to_wire(request, 1).value();
    if (forge) forge(sample.message);
    ASSERT_TRUE(eventually([this] {
      dds_publication_matched_status_t status{};
      return dds_get_publication_matched_status(writer.handle(), &status) == 0 && status.current_count > 0;
    }));
    ASSERT_TRUE(check(dds_write(writer.handle(), &sample.message), "write"));
  }
  Participant seat;
  Entity publisher, writer;
};

}  // namespace liloc::wire
