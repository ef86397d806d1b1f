#include "proto-tests/load/part.hpp"

#include <algorithm>
#include <atomic>
#include <queue>
#include <thread>

#include "proto-tests/replay/processes.hpp"

namespace liloc::load {
namespace {

constexpr double kJoinAhead_s =
    1.5;  // until server and device have found each other: SPDP goes out every second
constexpr double kLastReply_s = 4.5;  // a client gives an answer up after 4 s

using Devices = std::vector<std::unique_ptr<Device>>;

void sleep_until(std::chrono::steady_clock::time_point due) {
  constexpr auto kLook = std::chrono::milliseconds(100);  // so that a signal is noticed
  while (!replay::stop_requested() && std::chrono::steady_clock::now() < due)
    std::this_thread::sleep_until(std::min(due, std::chrono::steady_clock::now() + kLook));
}

/// Has the devices come and go, beside the thread that ticks.
Status bring_in_and_out(const Devices& devices, const RunClock& clock, const wire::DomainOptions& seat) {
  struct Move {
    double at_s;
    Device* device;
    bool in;
  };
  std::vector<Move> moves;
  for (const auto& device : devices) {
    moves.push_back({device->plan().start_s - kJoinAhead_s, device.get(), true});
    moves.push_back({device->plan().end_s + kLastReply_s, device.get(), false});
  }
  std::ranges::stable_sort(moves, {}, &Move::at_s);
  for (const Move& move : moves) {
    sleep_until(clock.at(move.at_s));
    if (replay::stop_requested()) break;
    if (!move.in)
      move.device->leave();
    else if (const Status joined = move.device->join(seat); !joined)
      return joined;
  }
  return {};
}

/// Frames of all devices, each at its time, until the last device has gone.
void tick_all(const Devices& devices, const RunClock& clock, const std::atomic<bool>& broken) {
  using Due = std::pair<double, Device*>;
  std::priority_queue<Due, std::vector<Due>, std::greater<>> due;
  for (const auto& device : devices) due.emplace(device->plan().start_s, device.get());
  while (!due.empty() && !broken && !replay::stop_requested()) {
    const auto [at_s, device] = due.top();
    due.pop();
    sleep_until(clock.at(at_s));
    device->tick(at_s);
    if (at_s + kFrame_s < device->plan().end_s) due.emplace(at_s + kFrame_s, device);
  }
}

}  // namespace

Result<Outcomes> play_part(const Script& script, const LoadOptions& options, const RunClock& clock,
                           const std::vector<DevicePlan>& plans, const wire::DomainOptions& seat) {
  Devices devices;
  for (const DevicePlan& plan : plans)
    devices.push_back(std::make_unique<Device>(script, options, clock, plan));
  Status moved;
  std::atomic<bool> broken = false;
  std::jthread usher([&] {
    moved = bring_in_and_out(devices, clock, seat);
    broken = !moved;
  });
  tick_all(devices, clock, broken);
  usher.join();
  for (const auto& device : devices) device->leave();
  if (!moved) return tl::unexpected(moved.error());
  Outcomes outcomes;
  for (const auto& device : devices) device->add_to(&outcomes);
  return outcomes;
}

}  // namespace liloc::load
