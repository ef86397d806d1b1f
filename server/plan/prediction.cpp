#include "server/plan/prediction.hpp"

#include <algorithm>
#include <cmath>

namespace liloc::plan {
namespace {

constexpr float kUpright = 0.5F;        // |normal.z| below which a surface stands; by hand
constexpr double kFewestSurfaces = 30;  // that a device must see; by hand

// Fitted by proto-tests/bench/fit_plan.py to sites 4001 to 4004 of liloc_plan_bench, commit 7e03407;
// DECISIONS.md has how it does on others.
constexpr double kOne = -6.077, kOverlap = 0.522, kUprightLog = 0.776, kWeakestLog = 1.051;

}  // namespace

void Support::add(const Eigen::Vector3f& normal_map, double sign) {
  covered += sign;
  if (std::abs(normal_map.z()) < kUpright) upright += sign;
  xx += sign * normal_map.x() * normal_map.x();
  xy += sign * normal_map.x() * normal_map.y();
  yy += sign * normal_map.y() * normal_map.y();
}

double Support::weakest() const {
  const double middle = 0.5 * (xx + yy);
  return std::max(0.0, middle - std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy));
}

double chance_verified(const ViewFeatures& f) {
  if (f.seen < kFewestSurfaces || f.support.covered <= 0) return 0;
  const double logit = kOne + kOverlap * f.support.covered / f.seen +
                       kUprightLog * std::log1p(f.support.upright) +
                       kWeakestLog * std::log1p(f.support.weakest());
  return 1 / (1 + std::exp(-logit));
}

}  // namespace liloc::plan
