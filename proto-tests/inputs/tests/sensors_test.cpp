// Sensors that lie, over DDS against a server process.
#include <numbers>

#include "proto-tests/inputs/tests/live_site.hpp"

namespace liloc::inputs {
namespace {

void degrees_per_second(ImuSample& sample) {
  sample.angular_velocity_rad_s *= 180 / std::numbers::pi;
}
void of_a_clock_37_s_ahead(ImuSample& sample) {
  sample.stamp_ns += from_seconds(37);
}
void half_a_second_ahead(ImuSample& sample) {
  sample.stamp_ns += from_ms(500);
}
void wild_once_in_two_seconds(ImuSample& sample) {
  if (sample.stamp_ns / from_ms(5) % 400 == 0) sample.angular_velocity_rad_s = {300, -300, 300};
}

/// As some drivers have it where nothing came back.
void largest_for_no_return(DepthImage& image) {
  std::ranges::replace(image.units, std::uint16_t{0}, std::uint16_t{65535});
}
void covered(DepthImage& image) {
  std::ranges::fill(image.units, std::uint16_t{0});
}
void in_another_unit(DepthImage& image) {
  for (std::uint16_t& units : image.units) units = static_cast<std::uint16_t>(units / 10);
}

struct Fault {
  std::size_t device;
  void (*change)(ImuSample&);
  std::vector<std::string> told;  ///< in `problem`, each of them
};

TEST_F(LiveSite, ImusThatLieAreNamedAndLeadNobodyAway) {  // and 65535 is no wall
  const std::vector<Fault> faults{{0, degrees_per_second, {"degrees per second", "left out"}},
                                  {3, of_a_clock_37_s_ahead, {"IMU stamps are 37.", "s ahead of", "left out"}},
                                  {4, half_a_second_ahead, {"IMU stamps are 0.", "s ahead of", "(corrected)"}},
                                  {5, wild_once_in_two_seconds, {}}};
  sim::SimOptions options = small_site(4, 6);
  options.depth_scale_m = 0.0001;  // by which 65535 would be a wall at 6.55 m
  options.lidar_range_m = options.device_range_m = 6;
  open(options);
  if (HasFatalFailure()) return;
  for (auto& image : site_->spoil.lidar_image) image = largest_for_no_return;
  for (auto& image : site_->spoil.device_image) image = largest_for_no_return;
  for (const Fault& fault : faults) {
    site_->spoil.imu.at(fault.device) = fault.change;
    add_robot(fault.device);
  }
  std::vector<std::string> told(faults.size());    // all that `problem` said
  std::vector<bool> located_after(faults.size());  // that it had been said
  int wrong = 0;
  const auto look = [&](std::size_t i) {
    if (const auto problem = robots_[i]->stats().problem; told[i].find(problem) == std::string::npos)
      told[i] += problem + "\n";
    const double error = robots_[i]->tracking() ? error_m(i) : std::numeric_limits<double>::infinity();
    if (std::isfinite(error) && error > 0.3) ++wrong;
    const bool said = std::ranges::all_of(
        faults[i].told, [&](const std::string& part) { return told[i].find(part) != std::string::npos; });
    if (said && error < 0.3) located_after[i] = true;
  };
  const auto done = [&] {
    for (std::size_t i = 0; i < faults.size(); ++i) look(i);
    return std::ranges::find(located_after, false) == located_after.end() &&
           robots_.back()->stats().imu_refused > 0;
  };
  const bool named = within(40s, done);
  if (!kMeasured) return;
  EXPECT_TRUE(named) << testing::PrintToString(told) << robots_told();
  EXPECT_EQ(wrong, 0) << robots_told();
}

TEST_F(LiveSite, LidarsThatAreBlindOrInAnotherUnitFailTheDoctor) {
  open(small_site(3, 1));
  if (HasFatalFailure()) return;
  add_robot(0);
  const auto becomes = [&](std::size_t lidar, wire::LidarState state) {
    return within(10s, [&] { return server_->lidar(lidar).state == state; }) || !kMeasured;
  };
  EXPECT_TRUE(becomes(1, wire::LidarState::ok) && becomes(2, wire::LidarState::ok)) << server_log();
  site_->spoil.lidar_image[1] = covered;
  site_->spoil.lidar_image[2] = in_another_unit;
  EXPECT_TRUE(becomes(1, wire::LidarState::blind)) << server_log();
  EXPECT_TRUE(becomes(2, wire::LidarState::implausible)) << server_log();
  const Outcome told = doctor();
  if (!kMeasured) return;
  EXPECT_EQ(told.exit_code, 1) << told.out;
  EXPECT_THAT(told.out, testing::HasSubstr("FAIL  edge: ceiling1 is blind, 0.0 %"));
  EXPECT_THAT(told.out, testing::HasSubstr("FAIL  edge: ceiling2 measures implausible ranges"));
  site_->spoil.lidar_image[1] = site_->spoil.lidar_image[2] = nullptr;
  EXPECT_TRUE(becomes(1, wire::LidarState::ok) && becomes(2, wire::LidarState::ok)) << server_log();
  EXPECT_TRUE(within(5s, [&] { return all_located() && error_m(0) < 0.3; })) << robots_told();
}

}  // namespace
}  // namespace liloc::inputs
