#include "proto-tests/soak/tape.hpp"

#include <algorithm>
#include <thread>

#include "proto-tests/replay/processes.hpp"

namespace liloc::soak {
namespace {

constexpr double kTurn_s = 0.1;  // of each lap, so that stamps rise where the tape turns
constexpr int kWays = 3;
constexpr double kDeviceRate_hz = 10, kLidarRate_hz = 6;  // as liloc load

sim::SimOptions site_options(const SoakOptions& options) {
  sim::SimOptions site;
  site.seed = options.seed;
  site.people = options.people;
  site.moved_items = site.pushed_items = 0;  // what is pushed would jump where the tape turns
  site.lidars = options.lidars;
  site.lidar_rate_hz = kLidarRate_hz;
  site.devices = kWays;
  site.device_rate_hz = kDeviceRate_hz;
  site.seconds = options.tape_s;
  site.still_seconds = 1;
  return site;
}

}  // namespace

Result<Tape> record_tape(const SoakOptions& options, const std::function<void(double)>& progress) {
  auto simulation = sim::Simulation::create(site_options(options));
  if (!simulation) return tl::unexpected(simulation.error());
  Tape tape;
  tape.site = simulation->site();
  tape.devices = simulation->devices();
  tape.seconds = options.tape_s;
  while (auto event = simulation->next()) {
    const double at_s = to_seconds(event->at_ns - simulation->start_ns());
    tape.events.push_back({at_s, std::move(event->payload)});
    if (replay::stop_requested()) return fail("soak: stopped by a signal");
    if (progress) progress(at_s / options.tape_s);
  }
  if (tape.events.empty()) return fail("soak: the simulated site gave nothing; try another --seed");
  return tape;
}

TapePlayer::Moment TapePlayer::next() {
  const std::size_t count = tape_.events.size(), lap = played_ / count, at = played_ % count;
  ++played_;
  const bool backwards = lap % 2 == 1;
  const TapeEvent& event = tape_.events[backwards ? count - 1 - at : at];
  const double within_s = backwards ? tape_.seconds - event.at_s : event.at_s;
  return {static_cast<double>(lap) * (tape_.seconds + kTurn_s) + within_s, &event, backwards};
}

ImuSample reversed(ImuSample sample) {
  sample.angular_velocity_rad_s = -sample.angular_velocity_rad_s;
  return sample;
}

RunClock RunClock::starting_in(double lead_s) {
  return {std::chrono::steady_clock::now() + std::chrono::nanoseconds(from_seconds(lead_s)),
          wall_clock_ns() + from_seconds(lead_s)};
}

void RunClock::sleep_until(double s) const {
  constexpr auto kLook = std::chrono::milliseconds(100);  // so that a signal is noticed
  while (!replay::stop_requested() && std::chrono::steady_clock::now() < at(s))
    std::this_thread::sleep_until(std::min(at(s), std::chrono::steady_clock::now() + kLook));
}

}  // namespace liloc::soak
