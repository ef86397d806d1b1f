#include "common/registration/target/surface_bits.hpp"

#include <algorithm>

namespace liloc {
namespace {

constexpr float kCellsPerMetre = 4;  // by hand: a few points of the thinned cloud (0.1 m) share a cell
constexpr float kReach_m = 0.1F;     // a voxel of the thinned clouds
// Cosine of 37 degrees: half of the way to the next of the field's directions; by hand.
constexpr float kFacing = 0.8F;

std::uint64_t cell_of(const Eigen::Vector3f& p_map) {
  const Eigen::Vector3i cell = (p_map * kCellsPerMetre).array().floor().cast<int>();
  const auto bits = [](int x) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(x) & 0x1FFFFFU); };
  return bits(cell.x()) << 42U | bits(cell.y()) << 21U | bits(cell.z());
}

}  // namespace

void SurfaceBits::add(const Target& target, const Cloud& cloud, const Pose& T_map_sensor) {
  const ScoreFields& field = target->field_coarse();
  const Eigen::Isometry3f T = T_map_sensor.cast<float>();
  if (!cloud.has_normals() || !target->coarse.has_normals()) return;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f p = T * cloud.points[i], normal = T.linear() * cloud.normals[i];
    const std::int32_t j = target->nearest_coarse.nearest(p);
    if (j == NearestGrid::kNone) continue;
    const auto at = static_cast<std::size_t>(j);
    if ((p - target->coarse.points[at]).squaredNorm() > kReach_m * kReach_m) continue;
    if (normal.dot(target->coarse.normals[at]) < kFacing) continue;
    const float worth = static_cast<float>(std::max(0, field.at(p, ScoreField::plane_of(normal)))) /
                        static_cast<float>(ScoreField::kSurface);
    float& known = worth_[cell_of(p)];
    sum_ += std::max(0.0F, worth - known);
    known = std::max(known, worth);
  }
}

}  // namespace liloc
