#include "common/registration/sight/panorama.hpp"

#include <algorithm>
#include <cmath>

namespace liloc {
namespace {

// By hand, where nothing else is said.
constexpr int kColumns = 180, kRows = 90;  // two degrees; by hand
constexpr float kTooNear_m = 0.3F;         // directions mean little so near to where the sensor moved about
// Of nine directions: between fewer points one may look through; by hand.
constexpr int kFewestNeighbours = 5;
constexpr float kHidden_m = 0.5F;  // behind the nearest about, a point hides; by hand
constexpr float kAgrees =
    5.0F / 3.0F;  // tolerances behind the nearest about: of slanted surfaces that is the edge
constexpr double kMostHidden =
    0.4;  // fragments of a hand-held camera: 0.16 to 0.31; rooms seen from elsewhere: over 0.5

int direction_of(const Eigen::Vector3f& p) {
  const float range = p.norm();
  if (!(range >= kTooNear_m)) return -1;
  constexpr auto kPi = static_cast<float>(M_PI);
  const int column = static_cast<int>((std::atan2(p.y(), p.x()) + kPi) / (2 * kPi) * kColumns) % kColumns;
  const int row =
      std::min(kRows - 1, static_cast<int>(std::acos(std::clamp(p.z() / range, -1.0F, 1.0F)) / kPi * kRows));
  return row * kColumns + column;
}

}  // namespace

Panorama::Panorama(const std::vector<Eigen::Vector3f>& points) {
  nearest_m_.assign(static_cast<std::size_t>(kColumns) * kRows, 0.0F);
  for (const Eigen::Vector3f& p : points) {
    const int at = direction_of(p);
    if (at < 0) continue;
    float& nearest = nearest_m_[static_cast<std::size_t>(at)];
    nearest = nearest == 0 ? p.norm() : std::min(nearest, p.norm());
  }
  std::vector<float> widened(nearest_m_.size());
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column)
      widened[static_cast<std::size_t>(row * kColumns + column)] = nearest_about(column, row);
  nearest_m_ = std::move(widened);
  int hidden = 0, known = 0;
  for (const Eigen::Vector3f& p : points) {
    const int at = direction_of(p);
    if (at < 0 || nearest_m_[static_cast<std::size_t>(at)] == 0) continue;
    ++known;
    hidden += p.norm() > nearest_m_[static_cast<std::size_t>(at)] + kHidden_m;
  }
  seen_from_origin_ = known > 0 && hidden <= kMostHidden * known;
}

float Panorama::nearest_about(int column, int row) const {
  float nearest = 0;
  int neighbours = 0;
  for (int v = std::max(0, row - 1); v <= std::min(kRows - 1, row + 1); ++v)
    for (int u = column - 1; u <= column + 1; ++u) {
      const float range = nearest_m_[static_cast<std::size_t>(v * kColumns + (u + kColumns) % kColumns)];
      if (range == 0) continue;
      ++neighbours;
      nearest = nearest == 0 ? range : std::min(nearest, range);
    }
  return neighbours < kFewestNeighbours ? 0 : nearest;
}

Panorama::Count Panorama::count(const std::vector<Eigen::Vector3f>& points, const Pose& T_origin_points,
                                double tolerance_m) const {
  const Eigen::Isometry3f T = T_origin_points.cast<float>();
  const auto tolerance = static_cast<float>(tolerance_m);
  Count count;
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Vector3f p = T * point;
    const int at = direction_of(p);
    if (at < 0 || nearest_m_[static_cast<std::size_t>(at)] == 0) continue;
    ++count.known;
    const float behind = p.norm() - nearest_m_[static_cast<std::size_t>(at)];
    count.conflict += behind < -tolerance;
    count.agree += behind >= -tolerance && behind < kAgrees * tolerance;
  }
  return count;
}

}  // namespace liloc
