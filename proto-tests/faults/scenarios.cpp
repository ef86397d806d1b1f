// Times are by hand: a device is located and followed well before the first trouble, and has time after it.
#include "proto-tests/faults/scenario.hpp"

namespace liloc::faults {
namespace {

constexpr double kTrouble_s = 8;
constexpr double kStandby_s = 3;    // the device follows the first server by then
constexpr double kRestart_s = 0.5;  // RestartSec of deploy/systemd/liloc-server.service.in

Act weather(double at_s, Mark mark, const char* host, const Weather& weather) {
  return {at_s, mark, [host, weather](Stage& stage) {
            stage.network().set(host, weather);
            return Status{};
          }};
}

Act does(double at_s, Mark mark, void (Stage::*what)(std::size_t), std::size_t server) {
  return {at_s, mark, [what, server](Stage& stage) {
            (stage.*what)(server);
            return Status{};
          }};
}

Scenario always(std::string name, std::string what, const char* host, const Weather& bad) {
  return {std::move(name), std::move(what), 20, 1, false, {}, {weather(0, Mark::none, host, bad)}};
}

Scenario cut(std::string name, std::string what, const char* host) {
  return {
      std::move(name),
      std::move(what),
      22,
      1,
      false,
      {},
      {weather(kTrouble_s, Mark::begins, host, {.cut = true}), weather(kTrouble_s + 5, Mark::over, host, {})}};
}

std::vector<Scenario> of_the_network() {
  return {
      {"calm", "nothing goes wrong", 20, 1, false, {}, {}},
      always("loss-5", "5 % of the frames on the device's link are lost", kDevice, {.loss = 0.05}),
      always("loss-10", "10 % are lost", kDevice, {.loss = 0.10}),
      always("loss-30", "30 % are lost", kDevice, {.loss = 0.30}),
      always("delay-200", "200 ms each way on the device's link", kDevice, {.delay_ms = 200}),
      always("reorder", "0 to 40 ms each way: what the device sends and hears is reordered", kDevice,
             {.delay_ms = 20, .jitter_ms = 20}),
      always("ceiling-loss-1", "1 % of the frames on the LiDARs' link are lost", kCeiling, {.loss = 0.01}),
      cut("partition", "the device's link is cut for 5 s", kDevice),
      cut("ceiling-partition", "the LiDARs' link is cut for 5 s", kCeiling),
      {"roaming",
       "the device's address changes",
       22,
       1,
       false,
       {},
       {{kTrouble_s, Mark::begins_and_over,
         [](Stage& stage) { return stage.change_device_address("10.77.0.104"); }}}},
  };
}

StreamFaults silence(std::vector<std::size_t> lidars, double from_s, double to_s) {
  StreamFaults faults;
  faults.silent_lidars = std::move(lidars);
  faults.silent_from_s = from_s;
  faults.silent_to_s = to_s;
  return faults;
}

StreamFaults steps(double device_s, double ceiling_s) {
  StreamFaults faults;
  faults.device_step_s = device_s;
  faults.ceiling_step_s = ceiling_s;
  faults.step_at_s = kTrouble_s;
  return faults;
}

/// What the streams do by themselves, marked.
Act happens(double at_s, Mark mark) {
  return {at_s, mark, [](Stage&) { return Status{}; }};
}

std::vector<Scenario> of_the_sensors() {
  const Act begins_and_over = happens(kTrouble_s, Mark::begins_and_over);
  return {
      {"lidar-dies",
       "one LiDAR of three falls silent",
       20,
       1,
       false,
       silence({0}, kTrouble_s, 1e9),
       {begins_and_over}},
      {"lidars-pause",
       "all LiDARs are silent for 4 s",
       20,
       1,
       false,
       silence({0, 1, 2}, kTrouble_s, kTrouble_s + 4),
       {happens(kTrouble_s, Mark::begins), happens(kTrouble_s + 4, Mark::over)}},
      {"clock-ahead", "the device's clock is set 5 s ahead", 20, 1, false, steps(5, 0), {begins_and_over}},
      {"clock-back", "the device's clock is set 5 s back", 20, 1, false, steps(-5.013, 0), {begins_and_over}},
      {"ceiling-clock", "the LiDARs' clock is set 2 s ahead", 22, 1, false, steps(0, 2), {begins_and_over}},
  };
}

std::vector<Scenario> of_the_programs() {
  const Act standby{kStandby_s, Mark::none, [](Stage& stage) { return stage.start_server(1); }};
  const Act restart{kTrouble_s + kRestart_s, Mark::over, [](Stage& stage) { return stage.start_server(0); }};
  const auto hangs = [](Stage& stage) { return stage.hang_workers(0); };
  const auto device = [](double at_s, Mark mark, void (Stage::*what)()) {
    return Act{at_s, mark, [what](Stage& stage) {
                 (stage.*what)();
                 return Status{};
               }};
  };
  return {
      {"server-killed",
       "kill -9 of the server, started again after 0.5 s",
       20,
       1,
       false,
       {},
       {does(kTrouble_s, Mark::begins, &Stage::kill_server, 0), restart}},
      {"server-frozen",
       "SIGSTOP of the server for 5 s",
       22,
       1,
       false,
       {},
       {does(kTrouble_s, Mark::begins, &Stage::freeze_server, 0),
        does(kTrouble_s + 5, Mark::over, &Stage::thaw_server, 0)}},
      {"device-frozen",
       "SIGSTOP of the device for 3 s",
       20,
       1,
       false,
       {},
       {device(kTrouble_s, Mark::begins, &Stage::freeze_device),
        device(kTrouble_s + 3, Mark::over, &Stage::thaw_device)}},
      {"disk-full",
       "the server's disk becomes full",
       20,
       1,
       true,
       {},
       {{kTrouble_s, Mark::begins_and_over, [](Stage& stage) { return stage.fill_disk(); }}}},
      {"failover-killed",
       "of two servers, kill -9 of the one that is followed",
       20,
       2,
       false,
       {},
       {standby, does(kTrouble_s, Mark::begins_and_over, &Stage::kill_server, 0)}},
      {"failover-frozen",
       "of two servers, SIGSTOP of one for 5 s",
       20,
       2,
       false,
       {},
       {standby, does(kTrouble_s, Mark::begins_and_over, &Stage::freeze_server, 0),
        does(kTrouble_s + 5, Mark::none, &Stage::thaw_server, 0)}},
      {"failover-hung",
       "of two servers, one's workers hang",
       20,
       2,
       false,
       {},
       {standby, {kTrouble_s, Mark::begins_and_over, hangs}}},
  };
}

}  // namespace

const std::vector<Scenario>& scenarios() {
  static const std::vector<Scenario> all = [] {
    std::vector<Scenario> made = of_the_network();
    for (auto* more : {&of_the_sensors, &of_the_programs})
      for (Scenario& scenario : more()) made.push_back(std::move(scenario));
    return made;
  }();
  return all;
}

Result<Scenario> scenario_named(const std::string& name) {
  std::string names;
  for (const Scenario& scenario : scenarios()) {
    if (scenario.name == name) return scenario;
    names += (names.empty() ? "" : ", ") + scenario.name;
  }
  return fail("\"{}\" is no scenario; there are {}", name, names);
}

}  // namespace liloc::faults
