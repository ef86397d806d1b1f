// A server for tests in other languages: says "odometry lies at (1, 2, 3)" to every request of its domain.
// client_answering_server DOMAIN   until its standard input ends; exit code 1 when it cannot join.
#include <cstdio>
#include <cstdlib>

#include "common/wire/server_link.hpp"

using namespace liloc;

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  auto participant = wire::Participant::create({.domain = std::atoi(argv[1]), .role = wire::Role::server});
  if (!participant) return 1;
  auto dispatcher = wire::Dispatcher::create(*participant);
  if (!dispatcher) return 1;
  wire::ServerLink* answering = nullptr;
  wire::ServerCallbacks callbacks;
  callbacks.on_request = [&](const wire::Arrival& arrival) {
    SpotReply reply = refusal(arrival.request, Reason::none, "by heart");
    reply.status = SpotStatus::verified;
    reply.reason = Reason::confirmed;
    reply.T_map_odom = Pose(Eigen::Translation3d(1, 2, 3));
    reply.T_map_sensor = *reply.T_map_odom * arrival.request.T_odom_sensor;
    reply.covariance = 1e-4 * Matrix6d::Identity();
    if (const Status sent = answering->reply(arrival.from, reply); !sent)
      fmt::print(stderr, "{}\n", sent.error().message);
  };
  auto link = wire::ServerLink::create(**dispatcher, {}, callbacks);
  if (!link) return 1;
  answering = link->get();
  (*dispatcher)->start();
  while (std::getchar() != EOF) {
  }
  (*dispatcher)->stop();
  return 0;
}
