#include "server/view/points_message.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

namespace liloc::view {
namespace {

static_assert(std::endian::native == std::endian::little, "the message is written as it lies in memory");

constexpr float kSteps = 65'535;  // of a coordinate over the box: 16 bits

template <class T>
void append(std::string& to, const T& value) {
  const auto at = to.size();
  to.resize(at + sizeof value);
  std::memcpy(to.data() + at, &value, sizeof value);
}

std::vector<Eigen::Vector3f> gathered(std::span<const Cloud* const> clouds_map) {
  std::size_t all = 0;
  for (const Cloud* cloud : clouds_map) all += cloud->size();
  const std::size_t every = std::max<std::size_t>(1, (all + kMostPoints - 1) / kMostPoints);
  std::vector<Eigen::Vector3f> points;
  points.reserve(all / every + 1);
  std::size_t at = 0;
  for (const Cloud* cloud : clouds_map)
    for (const Eigen::Vector3f& p : cloud->points)
      if (at++ % every == 0 && p.allFinite()) points.push_back(p);
  return points;
}

}  // namespace

std::string points_message(Points kind, std::span<const Cloud* const> clouds_map) {
  const auto points = gathered(clouds_map);
  Eigen::AlignedBox3f bounds;
  for (const auto& p : points) bounds.extend(p);
  if (points.empty()) bounds = Eigen::AlignedBox3f(Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero());
  const Eigen::Vector3f low = bounds.min();
  const Eigen::Vector3f step = (bounds.sizes() / kSteps).cwiseMax(1e-6F);  // a flat cloud has no thickness

  std::string bytes;
  bytes.reserve(32 + 6 * points.size());
  append(bytes, static_cast<std::uint8_t>(kind));
  append(bytes, std::uint8_t{1});
  append(bytes, std::uint16_t{0});
  append(bytes, static_cast<std::uint32_t>(points.size()));
  for (const auto& v : {low, step})
    for (const float f : v) append(bytes, f);
  for (const auto& p : points) {
    const Eigen::Array3f at = ((p - low).array() / step.array()).round().max(0.0F).min(kSteps);
    for (const float f : at) append(bytes, static_cast<std::uint16_t>(f));
  }
  return bytes;
}

}  // namespace liloc::view
