#pragma once
// A simulated site that streams, a server process beside it, and devices.
#include <gmock/gmock.h>

#include "common/testing/program.hpp"
#include "common/testing/within.hpp"
#include "proto-tests/inputs/played_site.hpp"
#include "proto-tests/inputs/robot.hpp"
#include "proto-tests/inputs/server_process.hpp"
#include "proto-tests/replay/tests/temp_folder.hpp"

namespace liloc::inputs {

using namespace std::chrono_literals;
using test::within;

#ifdef LILOC_SANITIZED
constexpr bool kMeasured = false;  // ten times slower: the processes are exercised, their answers come too late
#else
constexpr bool kMeasured = true;
#endif

inline sim::SimOptions small_site(int lidars, int devices) {
  sim::SimOptions options;
  options.seed = 21;
  options.seconds = 600;
  options.still_seconds = 1;
  options.people = 1;
  options.lidars = lidars;
  options.devices = devices;
  options.device_rate_hz = 10;
  options.image_width = 160;
  options.image_height = 120;
  return options;
}

class LiveSite : public testing::Test {
 protected:
  void open(const sim::SimOptions& options) {
    const auto free = replay::free_domain();
    ASSERT_TRUE(free) << free.error().message;
    domain_ = *free;
    auto site = PlayedSite::start(options, {domain_});
    ASSERT_TRUE(site) << site.error().message;
    site_ = std::move(*site);
    ASSERT_TRUE(site_->describe(folder_.path()));
    auto server = ServerProcess::start(domain_, folder_.path() / "site.json", folder_.path() / "server.log");
    ASSERT_TRUE(server) << server.error().message;
    server_ = std::move(*server);
    ASSERT_TRUE(within(30s, [&] { return server_->status().has_value(); })) << server_log();
  }
  /// Arguments of the client of one of the site's devices.
  [[nodiscard]] std::vector<std::string> device(std::size_t index) const {
    const std::string id = site_->devices()[index].id;
    return {"--id",     id,
            "--domain", std::to_string(domain_),
            "--device", (folder_.path() / (id + ".json")).string()};
  }
  /// `more` arguments of its client.
  void add_robot(std::size_t of_device, const std::vector<std::string>& more = {}) {
    auto arguments = device(of_device);
    arguments.insert(arguments.end(), more.begin(), more.end());
    auto robot = Robot::start(arguments);
    ASSERT_TRUE(robot) << robot.error().message;
    robots_.push_back(std::move(*robot));
    devices_.push_back(of_device);
  }
  [[nodiscard]] bool all_located() const {
    return all([](const Robot& robot) { return robot.tracking() && robot.newest().T_map_sensor; });
  }
  [[nodiscard]] bool all(const std::function<bool(const Robot&)>& holds) const {
    return std::ranges::all_of(robots_, [&](const auto& robot) { return holds(*robot); });
  }
  [[nodiscard]] Outcome doctor() const {
    return run_program(LILOC_PROGRAM, "doctor --seconds 10 --domain " + std::to_string(domain_));
  }
  /// Of a robot's newest pose, against the truth of its frame; infinite where it has none.
  [[nodiscard]] double error_m(std::size_t index) const {
    const client::PoseUpdate newest = robots_[index]->newest();
    const auto truth = site_->truth(devices_[index], newest.stamp_ns);
    if (!newest.T_map_sensor || !truth) return std::numeric_limits<double>::infinity();
    return (Eigen::Vector3d(newest.T_map_sensor->translation_m.data()) - truth->translation()).norm();
  }
  [[nodiscard]] std::string server_log() const { return replay::last_lines(folder_.path() / "server.log", 20); }
  /// For a failed expectation: how each robot fares.
  [[nodiscard]] std::string robots_told() const {
    std::string told;
    for (const auto& robot : robots_) {
      const auto newest = robot->newest();
      const auto stats = robot->stats();
      told += fmt::format("state {}, segment {}, {} frames, {} refused, {} IMU and {} odometry refused: {}\n",
                          static_cast<int>(newest.state), newest.odom_segment, stats.frames,
                          stats.frames_refused, stats.imu_refused, stats.odometry_refused, stats.problem);
    }
    return told + server_log();
  }

  int domain_ = 0;
  replay::TempFolder folder_;
  std::unique_ptr<PlayedSite> site_;
  std::unique_ptr<ServerProcess> server_;
  std::vector<std::unique_ptr<Robot>> robots_;
  std::vector<std::size_t> devices_;  ///< whose each robot is
};

}  // namespace liloc::inputs
