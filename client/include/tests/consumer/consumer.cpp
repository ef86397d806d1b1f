// A robot's program in C++17: built against the installed package alone. consumer DOMAIN; exit code 0: all
// held.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <liloc/client.hpp>
#include <thread>

#include "box_frames.h"

namespace {

using namespace liloc::client;

void check(bool held, const std::string& what) {
  if (held) return;
  std::fprintf(stderr, "not so: %s\n", what.c_str());
  std::exit(1);
}

Options box_options(int domain) {
  Options options;
  options.id = "consumer-cpp";
  options.domain = domain;
  options.queue_frames = FRAME_COUNT;
  options.camera = {
      FRAME_WIDTH, FRAME_HEIGHT, FOCAL_PX, FOCAL_PX, (FRAME_WIDTH - 1) / 2.0, (FRAME_HEIGHT - 1) / 2.0, UNIT_M};
  return options;
}

void check_misuse(Options options) {
  options.voxel_size_m = 7;
  const auto refused = Client::create(options);
  check(!refused && refused.error().find("voxel_size_m") != std::string::npos, "a bad option is named");
}

struct Seen {
  int poses = 0;
  Pose first, last;
};

bool all_processed(const Client& client) {
  for (int i = 0; i < 4000; ++i) {
    if (client.stats().frames == FRAME_COUNT) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

}  // namespace

int main(int argc, char** argv) {
  check(argc == 2, "usage: consumer DOMAIN");
  const Options options = box_options(std::atoi(argv[1]));
  check_misuse(options);
  Seen seen;  // outlives the client, whose thread writes it
  auto made = Client::create(options, [&](const PoseUpdate& update) {
    if (seen.poses++ == 0) seen.first = update.T_odom_sensor;
    seen.last = update.T_odom_sensor;
  });
  check(bool(made), made.error());
  Client& client = *made.value();

  std::vector<std::uint16_t> units(FRAME_WIDTH * FRAME_HEIGHT);
  check(!client.push_depth(units.data(), 8, 8, 1), "an image of another size is refused");
  check(!client.push_imu(1, {0, 0, 0}, {0, 0, 9.81}), "an IMU sample without an IMU is refused");
  for (int i = 0; i < FRAME_COUNT; ++i) {
    render_frame(i, units.data());
    const auto pushed = client.push_depth(units.data(), FRAME_WIDTH, FRAME_HEIGHT, frame_stamp_ns(i));
    check(bool(pushed), pushed.error());
  }
  check(all_processed(client), "all frames are processed within 20 s");
  const PoseUpdate newest = client.newest();
  check(bool(client.stop()), "an ordered stop");
  check(!client.push_depth(units.data(), FRAME_WIDTH, FRAME_HEIGHT, frame_stamp_ns(FRAME_COUNT)), "stopped");

  check(seen.poses == FRAME_COUNT, "a callback for every frame");
  check(newest.stamp_ns == frame_stamp_ns(FRAME_COUNT - 1) && newest.converged, "the newest pose is measured");
  check(newest.observed[0] > 0.9 && newest.observed[5] > 0.9, "by a frame that shows every motion");
  check(!newest.T_map_sensor && newest.state == State::searching, "without a server there is no global pose");
  const double walked = distance_m(seen.first.translation_m.data(), seen.last.translation_m.data());
  const double turned = angle_rad(seen.first.rotation_xyzw.data(), seen.last.rotation_xyzw.data());
  std::printf("walked %.4f m, turned %.4f rad\n", walked, turned);
  check(std::abs(walked - walked_m()) < 0.03, "walked 0.58 m");
  check(std::abs(turned - turned_rad()) < 0.02, "turned 0.232 rad");
  return 0;
}
