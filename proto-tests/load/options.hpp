#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "common/protocol/spot.hpp"
#include "proto-tests/sim/base/options.hpp"

namespace liloc::load {

/// What `liloc load` can be asked for. Times in seconds since the run's start unless a name says otherwise.
struct LoadOptions {
  std::filesystem::path out;                     ///< load.json, load.svg, site.json and server.log go there
  std::filesystem::path programs;                ///< folder of liloc-server
  std::vector<int> clients{20};                  ///< a run for each, 1..1000
  double seconds = 30;                           ///< measured, after the warm-up
  double interval_ms = to_ms(kRequestInterval);  ///< between a device's requests
  std::uint64_t seed = 7;
  sim::SiteKind kind = sim::SiteKind::office;
  int people = 2, lidars = 3;
  double lidar_rate_hz = 6;
  int paths = 6;          ///< simulated ways; devices share them, each with frames at times of its own
  double path_s = 20;     ///< length of a way, walked to and fro
  int processes = 1;      ///< that play the devices
  double lost_share = 0;  ///< of the devices: they lose their odometry, all at one moment
  double kidnap_s = 0;    ///< mean time until a device is carried elsewhere unnoticed; 0: never
  double churn_s = 0;     ///< mean time that a device stays; another then takes its place; 0: for good
  double frame_loss = 0.02;
  double clock_offset_s = 2;                ///< devices' clocks are off by up to so much
  double freeze_s = 0;                      ///< the server is stopped for so long in the middle of the run
  bool in_phase = false;                    ///< all devices start at one moment
  std::vector<std::string> server_options;  ///< further ones, for liloc-server
  int domain = -1;                          ///< of a server that runs already; -1: start one
  std::string server;                       ///< its host; empty: this one
  std::string credentials;                  ///< a server's, for all who take part; empty: none

  /// Devices come in over most of the warm-up; all that follows is measured.
  [[nodiscard]] static double warmup_s(int clients) { return 6 + 0.05 * clients; }
  /// Errors name the option and its range.
  [[nodiscard]] Status validated() const;
};

/// 1, 2, 5, 10, 20, 50 ... from the first to the last of `A:B`, both included. Errors: not of that form.
[[nodiscard]] Result<std::vector<int>> ramp_of(const std::string& text);

}  // namespace liloc::load
