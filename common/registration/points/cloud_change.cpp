#include "common/registration/points/cloud_change.hpp"

#include <algorithm>
#include <bit>

namespace liloc {
namespace {

constexpr std::int32_t kFree = -1;

std::uint64_t hash_of(const Eigen::Vector3f& p) {
  std::uint64_t hash = 0;
  for (const float value : {p.x(), p.y(), p.z()})
    hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x9E3779B97F4A7C15ULL;
  return hash;
}

bool same(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const auto bits = [](float value) { return std::bit_cast<std::uint32_t>(value); };
  return bits(a.x()) == bits(b.x()) && bits(a.y()) == bits(b.y()) && bits(a.z()) == bits(b.z());
}

/// Finds a cloud's points by their bits.
class PointTable {
 public:
  explicit PointTable(const Cloud& cloud) : cloud_(cloud), slots_(std::bit_ceil(2 * cloud.size() + 2), kFree) {
    shift_ = 64 - std::countr_zero(slots_.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      std::size_t slot = hash_of(cloud.points[i]) >> shift_;
      while (slots_[slot] != kFree) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = static_cast<std::int32_t>(i);
    }
  }
  /// The index of the point with this normal, or CloudChange::kGone.
  [[nodiscard]] std::int32_t find(const Eigen::Vector3f& p, const Eigen::Vector3f* normal) const {
    for (std::size_t slot = hash_of(p) >> shift_; slots_[slot] != kFree;
         slot = (slot + 1) & (slots_.size() - 1)) {
      const auto i = static_cast<std::size_t>(slots_[slot]);
      if (same(cloud_.points[i], p) && (normal == nullptr || same(cloud_.normals[i], *normal)))
        return slots_[slot];
    }
    return CloudChange::kGone;
  }

 private:
  const Cloud& cloud_;
  std::vector<std::int32_t> slots_;
  int shift_ = 0;
};

/// A longest part of the sequence that rises: indices into it. Patience sorting; nearly all of it rises.
std::vector<std::int32_t> longest_rise(const std::vector<std::int32_t>& sequence) {
  std::vector<std::int32_t> tops, before(sequence.size(), -1);  // tops: the least end of a rise of each length
  const auto value = [&](std::int32_t k) { return sequence[static_cast<std::size_t>(k)]; };
  for (std::int32_t k = 0; k < static_cast<std::int32_t>(sequence.size()); ++k) {
    const auto place = tops.empty() || value(tops.back()) < value(k)
                           ? tops.end()
                           : std::ranges::lower_bound(tops, value(k), {}, value);
    if (place != tops.begin()) before[static_cast<std::size_t>(k)] = *(place - 1);
    if (place == tops.end())
      tops.push_back(k);
    else
      *place = k;
  }
  std::vector<std::int32_t> rise(tops.size());
  for (std::size_t i = tops.size(); i > 0; --i)
    rise[i - 1] = i == tops.size() ? tops.back() : before[static_cast<std::size_t>(rise[i])];
  return rise;
}

}  // namespace

CloudChange change_between(const Cloud& before, const Cloud& now) {
  CloudChange change;
  change.now.assign(before.size(), CloudChange::kGone);
  std::vector<bool> stays(now.size(), false);
  if (now.has_normals() == before.has_normals()) {
    const PointTable table(before);
    std::vector<std::int32_t> was, index;  // of the points that were there before, in their order now
    for (std::size_t i = 0; i < now.size(); ++i) {
      const std::int32_t found = table.find(now.points[i], now.has_normals() ? &now.normals[i] : nullptr);
      if (found == CloudChange::kGone) continue;
      was.push_back(found);
      index.push_back(static_cast<std::int32_t>(i));
    }
    for (const std::int32_t k : longest_rise(was)) {
      const std::int32_t i = index[static_cast<std::size_t>(k)];
      change.now[static_cast<std::size_t>(was[static_cast<std::size_t>(k)])] = i;
      stays[static_cast<std::size_t>(i)] = true;
    }
  }
  for (std::uint32_t i = 0; i < now.size(); ++i)
    if (!stays[i]) change.fresh.push_back(i);
  for (std::size_t i = 0; i < before.size(); ++i)
    if (change.now[i] == CloudChange::kGone && before.points[i].allFinite())
      change.gone.push_back(before.points[i]);
  return change;
}

}  // namespace liloc
