// A server for tests in other languages: says "odometry lies at (1, 2, 3)" to every request of its domain.
// client_answering_server DOMAIN   until its standard input ends; exit code 1 when it cannot join.
#include <cstdio>
#include <cstdlib>

#include "client/api/tests/by_heart_server.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto server = liloc::test::ByHeartServer::start(std::atoi(argv[1]));
  if (!server) {
    fmt::print(stderr, "{}\n", server.error().message);
    return 1;
  }
  while (std::getchar() != EOF) {
  }
  return 0;
}
