#pragma once
// A server for tests of clients: says "odometry lies at (1, 2, 3)" to every request.
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/wire/spots/server_link.hpp"

namespace liloc::test {

class ByHeartServer {
 public:
  /// May change the answer before it leaves; on the dispatcher's thread.
  using Finish = std::function<void(const wire::Arrival&, SpotReply&)>;

  [[nodiscard]] static Result<std::unique_ptr<ByHeartServer>> start(int domain, const std::string& id = "edge1",
                                                                    Finish finish = {}) {
    auto participant = wire::Participant::create({.domain = domain, .role = wire::Role::server});
    if (!participant) return tl::unexpected(participant.error());
    std::unique_ptr<ByHeartServer> server(new ByHeartServer(*participant, std::move(finish)));
    auto dispatcher = wire::Dispatcher::create(server->participant_);
    if (!dispatcher) return tl::unexpected(dispatcher.error());
    server->dispatcher_ = std::move(*dispatcher);
    auto link = wire::ServerLink::create(
        *server->dispatcher_, {.server_id = id},
        {.on_request = [raw = server.get()](const wire::Arrival& arrival) { raw->answer(arrival); }});
    if (!link) return tl::unexpected(link.error());
    server->link_ = std::move(*link);
    server->dispatcher_->start();
    return server;
  }
  ~ByHeartServer() {
    if (dispatcher_) dispatcher_->stop();
  }
  ByHeartServer(const ByHeartServer&) = delete;
  ByHeartServer& operator=(const ByHeartServer&) = delete;

 private:
  ByHeartServer(wire::Participant participant, Finish finish)
      : participant_(std::move(participant)), finish_(std::move(finish)) {}

  void answer(const wire::Arrival& arrival) const {
    SpotReply reply = refusal(arrival.request, Reason::none, "by heart");
    reply.status = SpotStatus::verified;
    reply.reason = Reason::confirmed;
    reply.T_map_odom = Pose(Eigen::Translation3d(1, 2, 3));
    reply.T_map_sensor = *reply.T_map_odom * arrival.request.T_odom_sensor;
    reply.covariance = 1e-4 * Matrix6d::Identity();
    if (finish_) finish_(arrival, reply);
    static_cast<void>(link_->reply(arrival.from, reply));  // a client that has left needs no answer
  }

  wire::Participant participant_;
  Finish finish_;
  std::unique_ptr<wire::Dispatcher> dispatcher_;
  std::unique_ptr<wire::ServerLink> link_;
};

}  // namespace liloc::test
