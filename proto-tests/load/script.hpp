#pragma once
// All that a run sends, computed before it: a run's generator only copies bytes and writes new stamps.
#include <functional>
#include <optional>
#include <vector>

#include "common/protocol/spot.hpp"
#include "common/recording/recording.hpp"
#include "proto-tests/load/options.hpp"

namespace liloc::load {

constexpr double kFrame_s = 0.1;  ///< between two frames of a device

/// One frame of a way, as the client's own engine saw it.
struct ScriptFrame {
  Pose T_map_sensor = Pose::Identity();  ///< the truth
  Pose T_odom_sensor = Pose::Identity();
  bool informative = false;
  std::optional<SpotRequest> request;  ///< as if asked at every frame; none of a frame that tells too little
};

/// A frame every kFrame_s, from the site's time 0. What was before odometry broke tells nothing.
using Path = std::vector<ScriptFrame>;

struct CeilingFrame {
  double at_s = 0;
  std::size_t lidar = 0;
  DepthImage image;
};

struct Script {
  Site site;
  std::vector<CeilingFrame> ceiling;  ///< by rising time, from 0 to `seconds`
  double seconds = 0;
  std::vector<Path> paths;  ///< none is empty
};

/// Simulates the site and runs a client's engine along each way; it knows where it is, as one that is tracked
/// does. Errors: of the simulation; no way gave a request; a stop signal.
[[nodiscard]] Result<Script> make_script(const LoadOptions& options,
                                         const std::function<void(double)>& progress);

/// Where something is that goes to and fro over `length`, after a way of `travelled` >= 0: 0..length.
[[nodiscard]] double to_and_fro(double travelled, double length);

}  // namespace liloc::load
