#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/base/result.hpp"

namespace liloc::soak {

/// What `liloc soak` can be asked for.
struct SoakOptions {
  std::filesystem::path out;       ///< soak.json, samples.csv, visits.csv, site.json and logs go there
  std::filesystem::path programs;  ///< folder of liloc-server and liloc-client
  double seconds = 600;            ///< 30 s to a week
  std::uint64_t seed = 7;
  int residents = 2;                        ///< liloc-client processes that stay
  int visitors = 4;                         ///< clients that come and go, at once
  double stay_s = 12;                       ///< mean time that one stays, 5 s or more
  double flap_s = 20;                       ///< mean time until a ceiling LiDAR goes for some seconds; 0: never
  double restart_s = 45;                    ///< between restarts of the standby, 15 s or more; 0: never
  int lidars = 3, people = 2;               ///< of the simulated site
  double tape_s = 20;                       ///< of its simulated time, played to and fro
  std::vector<std::string> server_options;  ///< further ones, for both servers

  /// Of the run's beginning nothing is judged: indices, heaps and what is learned of the site fill up.
  [[nodiscard]] double warmup_s() const;
  /// Errors name the option and its range.
  [[nodiscard]] Status validated() const;
};

}  // namespace liloc::soak
