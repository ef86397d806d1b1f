#include "server/app/site_memory.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/log.hpp"

namespace liloc {
namespace {

/// Nothing that is worth a write: within a tenth, at 3 m; by hand.
bool much_the_same(const std::vector<DepthNoise>& a, const std::vector<DepthNoise>& b) {
  return a.size() == b.size() && std::ranges::equal(a, b, [](const DepthNoise& x, const DepthNoise& y) {
           return (x.samples > 0) == (y.samples > 0) &&
                  std::abs(x.sigma_m(3) - y.sigma_m(3)) < 0.1 * y.sigma_m(3) &&
                  std::abs(x.missing - y.missing) < 0.1;
         });
}

}  // namespace

SiteMemory::SiteMemory(const std::string& file, const Site& site, double voxel_size_m)
    : site_(site),
      voxel_size_m_(voxel_size_m),
      state_(file.empty() ? SiteState{} : open_site_state(file, site, voxel_size_m)),
      saved_noise_(state_.noise) {}

void SiteMemory::save(std::shared_ptr<const CellBounds> learned, std::vector<DepthNoise> noise) {
  if (state_.file.empty() || (learned == saved_ && much_the_same(noise, saved_noise_))) return;
  if (const Status written = write_site_state(state_.file, site_, voxel_size_m_, *learned, noise); !written)
    log::warning("{}; or name another with --state", written.error().message);
  saved_ = std::move(learned);
  saved_noise_ = std::move(noise);
}

}  // namespace liloc
