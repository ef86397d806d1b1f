#pragma once
// Which devices take part in a run, when, and what befalls them: drawn by the seed before it starts.
#include <limits>
#include <string>
#include <vector>

#include "proto-tests/load/options.hpp"

namespace liloc::load {

struct DevicePlan {
  std::string id;
  std::size_t path = 0;                                        ///< its way
  double start_s = 0, end_s = 0;                               ///< of its time here
  double lost_at_s = std::numeric_limits<double>::infinity();  ///< when it loses its odometry
  std::vector<double> kidnaps_s;                               ///< when it is carried elsewhere, rising
  double clock_offset_s = 0;                                   ///< its clock minus this machine's
  std::uint64_t seed = 0;
};

/// Devices that are there at once number `clients`; where devices come and go, more take part in all.
[[nodiscard]] std::vector<DevicePlan> draw_plans(const LoadOptions& options, int clients, std::size_t paths);

}  // namespace liloc::load
