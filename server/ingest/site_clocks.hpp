#pragma once
// One clock for a site from the stamps of its ceiling LiDARs. Times are passed in: no clock in here.
#include <optional>
#include <vector>

#include "common/base/result.hpp"
#include "common/base/stamp.hpp"
#include "common/base/stamp_clock.hpp"

namespace liloc {

/// How far a LiDAR's clock is from the site's, and what is done about it.
struct LidarClock {
  StampNs ahead_ns = 0;
  bool corrected = false;  ///< its stamps are set right by `ahead_ns`
  bool left_out = false;   ///< off, and not (yet) known well enough to be corrected
};

/// The site's clock is that of the largest group of LiDARs whose clocks agree; among groups of one size, the
/// one nearest to this host's clock if that is within ten seconds, else the one that was gone by before.
/// Whoever is off steadily is corrected, drift and all, whoever else is off is left out. Not thread-safe.
class SiteClocks {
 public:
  using Time = StampClock::Time;
  explicit SiteClocks(std::size_t lidars) : lidars_(lidars) {}

  /// What a LiDAR's stamp is by the site's clock. Empty: its clock is off and not known well enough; the frame
  /// is to be left out. `wall_ns`: this host's clock at `arrived`.
  [[nodiscard]] std::optional<StampNs> add(std::size_t lidar, StampNs stamp_ns, Time arrived, StampNs wall_ns);
  /// The site's clock; empty where no LiDAR is heard.
  [[nodiscard]] std::optional<StampNs> now(Time at) const;
  [[nodiscard]] LidarClock offset(std::size_t lidar) const { return lidars_[lidar].offset; }

 private:
  struct Lidar {
    StampClock clock;
    LidarClock offset;
    std::optional<Time> steady_since;  ///< since when it has not jumped
    StampNs steady_ns = 0;             ///< mean of late: clocks drift
  };
  void choose(Time at, StampNs wall_ns);
  void judge(Lidar& lidar, StampNs ahead_ns, Time at);

  std::vector<Lidar> lidars_;
  std::optional<StampNs> lead_ns_;  ///< the site's clock ahead of the steady clock, as chosen last
};

}  // namespace liloc
