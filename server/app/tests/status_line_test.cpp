#include "server/app/status_line.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

TEST(StatusLine, NamesEachLidarAndItsNoiseWhereThatIsKnown) {
  wire::ServerStatus status;
  status.clients = 2;
  status.queued = 1;
  status.answered = 9;
  status.verified = 7;
  status.refused = 1;
  EXPECT_EQ(status_line(status, {}), "2 clients, 1 queued, 9 answered (7 verified, 1 refused); ");
  status.lidars.resize(2);
  status.lidars[0].id = "north";
  status.lidars[0].state = wire::LidarState::ok;
  status.lidars[0].measured_hz = 9.96;
  status.lidars[1].id = "south";
  DepthNoise noise;
  noise.base_m = 0.004;
  noise.per_square_m = 0.001;
  noise.missing = 0.125;
  noise.samples = 5;
  EXPECT_EQ(
      status_line(status, {noise, {}}),
      "2 clients, 1 queued, 9 answered (7 verified, 1 refused); north ok 10.0 Hz (noise 13 mm at 3 m, 12 % "
      "missing), south waiting 0.0 Hz");
}

}  // namespace
}  // namespace liloc
