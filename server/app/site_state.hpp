#pragma once
// What a server learns of its site and keeps beside the site's description, so that a restart loses nothing.
#include <string>
#include <vector>

#include "common/geometry/camera.hpp"
#include "common/registration/search/cell_bounds.hpp"
#include "server/global_cloud/depth_noise.hpp"

namespace liloc {

/// The state beside a site file: "x/site.json" has "x/site.state.json", and "x/site.standby.state.json" of a
/// second server on the same host.
[[nodiscard]] std::string state_file_of(const std::string& site_file, bool standby = false);

/// Errors name the file, the field and the remedy: not a state of this version, learned with other voxels or
/// under other ceiling LiDARs, or a value out of range. A file that does not exist is an empty state.
[[nodiscard]] Result<CellBounds> read_site_state(const std::string& file, const Site& site,
                                                 double voxel_size_m);

/// How each LiDAR errs, in the site's order, as the same file has it; the defaults where it has nothing or what
/// no sensor can be.
[[nodiscard]] std::vector<DepthNoise> read_noise(const std::string& file, const Site& site);

struct SiteState {
  CellBounds learned;
  std::vector<DepthNoise> noise;  ///< per LiDAR, in the site's order
  std::string file;               ///< to keep it in; empty: in memory alone
};
/// `read_site_state`, but a server starts in any case: what cannot be used is told in the log and put aside
/// under a free name, FILE.unreadable or FILE.unreadable-2 ...; what cannot be put aside stays as it is.
[[nodiscard]] SiteState open_site_state(const std::string& file, const Site& site, double voxel_size_m);

/// Complete or not at all.
[[nodiscard]] Status write_site_state(const std::string& file, const Site& site, double voxel_size_m,
                                      const CellBounds& bounds, const std::vector<DepthNoise>& noise = {});

}  // namespace liloc
