// Clocks that are set, stray stamps and clocks of ceiling LiDARs, over DDS against a server process.
#include <cmath>
#include <cstdlib>

#include "proto-tests/inputs/tests/live_site.hpp"

namespace liloc::inputs {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;

/// Programs that want to run, for each core.
double load() {
  double programs = 0;
  (void)getloadavg(&programs, 1);
  return programs / std::max(1U, std::thread::hardware_concurrency());
}

constexpr double kOverloaded = 2.5;  // beyond, frames of ten a second are late or never come

/// The project's bound from a good stream to a located device, and a moment more.
constexpr auto kSoon = 3500ms;

class Clocks : public LiveSite {
 protected:
  void SetUp() override {
    if (load() > kOverloaded)
      GTEST_SKIP() << "others' work keeps this computer: " << load() << " programs a core";
    open(small_site(4, 3));
    if (HasFatalFailure()) return;
    add_robot(0);
    add_robot(1, {"--points-topic", "device1/points"});
    add_robot(2, {"--odometry-topic", "device2/odom"});
    ASSERT_TRUE(within(60s, [&] { return all_located(); }) || !kMeasured) << robots_told();
  }
  [[nodiscard]] std::vector<std::uint32_t> segments() const {
    std::vector<std::uint32_t> all;
    for (const auto& robot : robots_) all.push_back(robot->newest().odom_segment);
    return all;
  }
  const std::function<bool()> all_right = [this] {
    return all_located() && error_m(0) < 0.3 && error_m(1) < 0.3 && error_m(2) < 0.3;
  };
  void set_clocks_back_and_locate();
  void fall_silent_and_locate();
  void send_strays_and_go_on();
};

/// Frames, clouds, IMU and odometry jump at once; each device begins a new segment and is found again.
void Clocks::set_clocks_back_and_locate() {
  const auto before = segments();
  std::vector<bool> told(robots_.size());
  std::vector<std::uint64_t> refused;
  for (const auto& robot : robots_) refused.push_back(robot->stats().frames_refused);
  site_->spoil.device_ahead_ns = -from_seconds(10);
  const bool located = within(kSoon, [&] {
    bool anew = true;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      if (robots_[i]->stats().problem.find("clock was set back by 10.0 s") != std::string::npos) told[i] = true;
      anew = anew && robots_[i]->newest().odom_segment > before[i] && error_m(i) < 0.3;
    }
    return anew && all_located();
  });
  EXPECT_TRUE(located) << robots_told();
  EXPECT_THAT(told, testing::Each(true)) << robots_told();
  for (const std::size_t i : {0U, 2U})  // clouds without a return are refused as well
    EXPECT_LE(robots_[i]->stats().frames_refused, refused[i] + 2) << robots_told();
}

/// Nobody tells tracking on a pose of long ago.
void Clocks::fall_silent_and_locate() {
  site_->spoil.devices_silent = true;
  EXPECT_TRUE(within(2500ms, [&] {
    return all([](const Robot& robot) {
      return robot.newest().state == client::State::lost &&
             robot.stats().problem.find("no depth frames for") != std::string::npos;
    });
  })) << robots_told();
  site_->spoil.devices_silent = false;
  EXPECT_TRUE(within(kSoon, all_right)) << robots_told();
}

void Clocks::send_strays_and_go_on() {
  const auto before = segments();
  std::vector<client::Stats> stats;
  for (const auto& robot : robots_) stats.push_back(robot->stats());
  for (std::size_t i = 0; i < robots_.size(); ++i)
    site_->spoil.stray_frame.at(i) = site_->spoil.stray_imu.at(i) = true;
  site_->spoil.stray_odometry = true;
  const auto until = std::chrono::steady_clock::now() + 1500ms;
  while (std::chrono::steady_clock::now() < until) {
    ASSERT_TRUE(all([](const Robot& robot) {  // a late answer is no fault of theirs
      return robot.tracking() || robot.newest().state == client::State::coasting;
    })) << robots_told();
    std::this_thread::sleep_for(20ms);
  }
  EXPECT_EQ(segments(), before);
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const auto now = robots_[i]->stats();
    EXPECT_GE(now.frames_refused, stats[i].frames_refused + 1) << i;
    EXPECT_EQ(now.imu_refused, stats[i].imu_refused + 1) << i;
    EXPECT_EQ(now.odometry_refused, stats[i].odometry_refused + (i == 2 ? 1 : 0)) << i;
    EXPECT_GT(now.frames, stats[i].frames + 5) << i;
    EXPECT_LT(error_m(i), 0.3) << i;
  }
}

TEST_F(Clocks, OfDevicesThatAreSetBackPauseOrStrayCostAMoment) {
  if (!kMeasured) return;
  set_clocks_back_and_locate();
  fall_silent_and_locate();
  if (HasFailure()) return;
  send_strays_and_go_on();
  EXPECT_TRUE(site_->trouble());
}

/// "liloc_lidar_clock_offset_seconds{lidar="ceiling0"} " and its number.
double metric(const std::string& page, const std::string& name) {
  const auto at = page.find(name + " ");
  return at == std::string::npos ? NAN : std::stod(page.substr(at + name.size()));
}

TEST_F(Clocks, OfCeilingLidarsAreCorrectedOrLeftOutAndToldEverywhere) {
  if (!kMeasured) return;
  const auto corrected = [&](std::size_t lidar, double by_s) {
    const auto health = server_->lidar(lidar);
    return health.state == wire::LidarState::ok && health.clock_corrected &&
           std::abs(health.clock_offset_s - by_s) < 0.2;
  };
  site_->spoil.lidar_ahead_ns[0] = from_seconds(37);
  EXPECT_TRUE(within(3s, [&] { return server_->lidar(0).state == wire::LidarState::clock_off; }));
  EXPECT_TRUE(within(6s, [&] { return corrected(0, 37); })) << server_log();
  {  // at twice the pace of time
    const std::jthread drift([&](const std::stop_token& stop) {
      for (; !stop.stop_requested(); std::this_thread::sleep_for(20ms))
        site_->spoil.lidar_ahead_ns[2] += from_ms(20);
    });
    EXPECT_TRUE(within(5s, [&] { return server_->lidar(2).state == wire::LidarState::clock_off; }));
    const std::string told = doctor().out;
    EXPECT_THAT(told,
                ContainsRegex("warn  edge: ceiling0 has a clock 3[67]\\.[0-9]+ s ahead of the site's, which"));
    EXPECT_THAT(told, HasSubstr("ok    edge: ceiling1 ok at"));
    EXPECT_THAT(told, HasSubstr("FAIL  edge: ceiling2 has another clock, "));
    EXPECT_EQ(metric(server_->page("/metrics"), "liloc_lidar_up{lidar=\"ceiling2\"}"), 0);
  }
  site_->spoil.lidar_ahead_ns[2] = 0;
  EXPECT_TRUE(within(8s, [&] { return server_->lidar(2).state == wire::LidarState::ok; })) << server_log();
  site_->spoil.lidar_ahead_ns[1] = from_seconds(37);  // two against two: the host's clock decides
  EXPECT_TRUE(within(8s, [&] { return corrected(0, 37) && corrected(1, 37); })) << server_log();
  const std::string two = doctor().out, metrics = server_->page("/metrics");
  for (const std::string id : {"ceiling0", "ceiling1"}) {
    EXPECT_THAT(two, HasSubstr("warn  edge: " + id + " has a clock"));
    EXPECT_NEAR(metric(metrics, "liloc_lidar_clock_offset_seconds{lidar=\"" + id + "\"}"), 37, 0.2);
    EXPECT_EQ(metric(metrics, "liloc_lidar_clock_corrected{lidar=\"" + id + "\"}"), 1);
  }
  EXPECT_THAT(two, AllOf(HasSubstr("ok    edge: ceiling2 ok at"), HasSubstr("ok    edge: ceiling3 ok at")));
  EXPECT_NEAR(metric(metrics, "liloc_lidar_clock_offset_seconds{lidar=\"ceiling2\"}"), 0, 0.2);
  EXPECT_TRUE(within(kSoon, all_right)) << robots_told();
}

}  // namespace
}  // namespace liloc::inputs
