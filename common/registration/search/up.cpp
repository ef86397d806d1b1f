#include "common/registration/search/up.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace liloc {
namespace {

using Normals = std::vector<Eigen::Vector3f>;

// By hand.
constexpr std::size_t kMostNormals = 4000, kMostAxes = 4;
constexpr double kSameAxis_rad = radians(20.0), kGate_rad = radians(12.0), kTightGate_rad = radians(6.0);
constexpr double kFewestOnPlane = 0.03;  // share of the normals: less is furniture; by hand

Normals evenly_picked(const Cloud& cloud) {
  Normals picked;
  const std::size_t stride = cloud.size() / kMostNormals + 1;
  for (std::size_t i = 0; i < cloud.normals.size(); i += stride)
    if (cloud.normals[i].allFinite() && cloud.normals[i].squaredNorm() > 0.5F)
      picked.push_back(cloud.normals[i]);
  return picked;
}

/// Directions that many normals share, sign aside: full cells of a coarse grid on the sphere.
std::vector<Eigen::Vector3d> crowded_directions(const Normals& normals) {
  std::map<std::array<int, 3>, std::pair<int, Eigen::Vector3d>> cells;
  for (const auto& n : normals) {
    Eigen::Index longest = 0;
    n.cwiseAbs().maxCoeff(&longest);
    const Eigen::Vector3f folded = n[longest] < 0 ? Eigen::Vector3f(-n) : n;
    const Eigen::Vector3i cell = (folded * 6.0F).array().round().cast<int>();
    auto& [count, sum] =
        cells.try_emplace({cell.x(), cell.y(), cell.z()}, 0, Eigen::Vector3d::Zero()).first->second;
    ++count;
    sum += folded.cast<double>();
  }
  std::vector<std::pair<int, Eigen::Vector3d>> sorted;
  for (const auto& [cell, held] : cells) sorted.push_back(held);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  if (sorted.size() > 3 * kMostAxes) sorted.resize(3 * kMostAxes);
  std::vector<Eigen::Vector3d> directions;
  for (const auto& [count, sum] : sorted) directions.push_back(sum.normalized());
  return directions;
}

/// The direction that the normals along it and across it, within `gate_rad`, agree on best.
Eigen::Vector3d agreed(const Normals& normals, const Eigen::Vector3d& axis, double gate_rad, bool across_too) {
  const double along = std::cos(gate_rad), across = std::sin(gate_rad);
  Eigen::Matrix3d votes = Eigen::Matrix3d::Zero();
  for (const auto& normal : normals) {
    const Eigen::Vector3d n = normal.cast<double>();
    const double cosine = std::abs(n.dot(axis));
    if (cosine > along) votes += n * n.transpose();
    if (across_too && cosine < across) votes -= n * n.transpose();
  }
  if (votes.isZero()) return axis;
  const Eigen::Vector3d found = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(votes).eigenvectors().col(2);
  return found.dot(axis) < 0 ? Eigen::Vector3d(-found) : found;
}

double angle_of_axes_rad(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::min(1.0, std::abs(a.dot(b))));
}

void add_axis(const Eigen::Vector3d& axis, std::vector<Eigen::Vector3d>* axes) {
  if (std::none_of(axes->begin(), axes->end(),
                   [&](const Eigen::Vector3d& a) { return angle_of_axes_rad(a, axis) < kSameAxis_rad; }))
    axes->push_back(axis);
}

struct Shares {
  double up = 0, down = 0, across = 0;
};

Shares shares_of(const Normals& normals, const Eigen::Vector3d& up) {
  Shares s;
  const double along = std::cos(kGate_rad), across = std::sin(kGate_rad);
  for (const auto& n : normals) {
    const double cosine = n.cast<double>().dot(up);
    s.up += cosine > along;
    s.down += cosine < -along;
    s.across += std::abs(cosine) < across;
  }
  const auto count = static_cast<double>(normals.size());
  return {s.up / count, s.down / count, s.across / count};
}

double confidence_of(const Shares& s, const Eigen::Vector3d& up, const Eigen::Vector3d& expected) {
  const double structure = s.up + s.down + s.across;
  const double planes = std::min(1.0, (s.up + 0.5 * s.down) / 0.2);  // floors are seen more often than ceilings
  const double likely = expected.isZero() ? 1.0 : std::clamp(0.3 + up.dot(expected.normalized()), 0.1, 1.0);
  return structure * (0.3 + 0.7 * planes) * likely;
}

}  // namespace

std::vector<UpHypothesis> find_up(const Cloud& cloud, const UpOptions& options) {
  if (!cloud.has_normals()) return {};
  const Normals normals = evenly_picked(cloud);
  if (normals.empty()) return {};
  std::vector<Eigen::Vector3d> axes;
  for (const Eigen::Vector3d& direction : crowded_directions(normals)) {
    const Eigen::Vector3d axis = agreed(normals, direction, kGate_rad, false);
    const Shares s = shares_of(normals, axis);
    if (s.up + s.down >= kFewestOnPlane && axes.size() < kMostAxes) add_axis(axis, &axes);
  }
  const std::size_t planes = axes.size();
  for (std::size_t i = 0; i < planes; ++i)  // two walls that meet tell up though no floor is seen
    for (std::size_t j = i + 1; j < planes; ++j)
      if (angle_of_axes_rad(axes[i], axes[j]) > radians(45.0))
        add_axis(axes[i].cross(axes[j]).normalized(), &axes);
  if (planes == 1) {  // a single wall leaves up to what is expected along it
    const Eigen::Vector3d along = options.expected - options.expected.dot(axes[0]) * axes[0];
    if (along.norm() > 0.3) add_axis(along.normalized(), &axes);
  }
  std::vector<UpHypothesis> found;
  for (const Eigen::Vector3d& rough : axes) {
    const Eigen::Vector3d axis = agreed(normals, agreed(normals, rough, kGate_rad, true), kTightGate_rad, true);
    for (const Eigen::Vector3d& up : {axis, Eigen::Vector3d(-axis)})
      found.push_back({up, confidence_of(shares_of(normals, up), up, options.expected)});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const UpHypothesis& a, const UpHypothesis& b) { return a.confidence > b.confidence; });
  if (found.size() > options.most) found.resize(options.most);
  return found;
}

Eigen::Vector3d up_of_map(const Cloud& cloud_map, const Eigen::Vector3d& expected) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const auto found = find_up(cloud_map, {expected, 1});
  if (found.empty()) return z;
  const Eigen::Vector3d& best = found.front().up;
  if (best.dot(z) > std::cos(kSameAxis_rad / 2)) return z;
  const Normals normals = evenly_picked(cloud_map);
  const auto structure = [&](const Eigen::Vector3d& up) {
    const Shares s = shares_of(normals, up);
    return s.up + s.down + s.across;
  };
  return structure(best) > 0.5 && structure(z) < 0.6 * structure(best) ? best : z;
}

}  // namespace liloc
