#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/protocol/spot.hpp"

namespace liloc::replay {

/// The command line of `liloc replay`, one field per option.
struct ReplayOptions {
  std::filesystem::path recording, out;
  bool lockstep = false;
  std::uint64_t seed = 1;
  double interval_ms = to_ms(kRequestInterval), voxel_m = 0.05;
  std::string method = "liloc", local = "cloud", features = "fpfh";
  std::string verify, icp;        ///< empty: the method's own
  std::filesystem::path weights;  ///< of the network, for features "learned"
  double sampling = 0.5;
  double risk = 1e-3;                ///< with which a verified answer may be wrong
  std::vector<std::string> devices;  ///< ids to replay; empty: all of the recording
  bool cold = false;
  bool submap = true;                ///< requests carry what the device saw shortly before
  double clock_ahead_ms = 0;         ///< of the devices: sent so much earlier than stamped; not in lockstep
  int threads = 1;                   ///< of the server, per request
  std::string codec = "draco";       ///< of the clouds that devices send
  double searching_interval_ms = 0;  ///< lower bound while nothing is verified; 0: a quarter of interval_ms
  std::string save_answers;          ///< DIR[:refused|wrong|all]; empty: none are kept
  std::filesystem::path programs;    ///< folder of liloc-server and liloc-client; used without lockstep

  /// Errors name the option, its value and what it may be.
  [[nodiscard]] Result<ReplayOptions> validated() const;
};

/// Called with the share of the work that is done, 0..1, from the thread that runs the replay.
using Progress = std::function<void(double share)>;

}  // namespace liloc::replay
