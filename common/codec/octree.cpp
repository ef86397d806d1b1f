#include "common/codec/octree.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace liloc::codec {
namespace {

static_assert(std::endian::native == std::endian::little, "the header is copied as it lies in memory");

constexpr std::array<std::uint8_t, 4> kMagic = {'L', 'O', 'C', '1'};  // our own format, version 1
constexpr int kMinDepth = 4, kMaxDepth = 12;  // by hand about the paper's 8 (section 3.1.3)

struct Header {
  std::array<std::uint8_t, 4> magic = kMagic;
  std::uint32_t depth = 0, leaves = 0;
  std::array<float, 3> corner_m{};
  float side_m = 0;
};
static_assert(sizeof(Header) == 28);

// Leaf cells as Morton codes, three bits a level, x lowest; sorted, so that a node's children are neighbours.
std::uint64_t morton(const Eigen::Vector3i& cell, int depth) {
  std::uint64_t code = 0;
  for (int bit = depth - 1; bit >= 0; --bit)
    for (int axis = 2; axis >= 0; --axis) code = code << 1 | static_cast<std::uint64_t>(cell[axis] >> bit & 1);
  return code;
}

Eigen::Vector3i cell_of_morton(std::uint64_t code, int depth) {
  Eigen::Vector3i cell = Eigen::Vector3i::Zero();
  for (int bit = 0; bit < depth; ++bit)
    for (int axis = 0; axis < 3; ++axis) cell[axis] |= static_cast<int>(code >> (3 * bit + axis) & 1) << bit;
  return cell;
}

}  // namespace

Result<std::vector<std::uint8_t>> encode_octree(const Cloud& cloud, int depth) {
  Eigen::AlignedBox3f box;
  for (const auto& p : cloud.points) box.extend(p);
  Header header;
  header.depth = static_cast<std::uint32_t>(depth);
  Eigen::Map<Eigen::Vector3f>(header.corner_m.data()) = box.min();
  header.side_m = std::max(box.sizes().maxCoeff(), 1e-3F);
  const float cells = static_cast<float>(1 << depth), per_m = cells / header.side_m;
  std::vector<std::uint64_t> leaves;
  leaves.reserve(cloud.size());
  for (const auto& p : cloud.points) {
    const Eigen::Vector3f scaled = ((p - box.min()) * per_m).cwiseMin(cells - 1);
    leaves.push_back(morton(scaled.cast<int>(), depth));
  }
  std::sort(leaves.begin(), leaves.end());
  leaves.erase(std::unique(leaves.begin(), leaves.end()), leaves.end());
  header.leaves = static_cast<std::uint32_t>(leaves.size());

  std::vector<std::uint8_t> bytes(sizeof header);
  std::memcpy(bytes.data(), &header, sizeof header);
  for (int level = depth - 1; level >= 0; --level) {  // the root's byte first
    std::uint64_t node = ~std::uint64_t{0};
    for (const auto leaf : leaves) {
      const std::uint64_t child = leaf >> (3 * level);
      if (child >> 3 != node) bytes.push_back(0);
      node = child >> 3;
      bytes.back() = static_cast<std::uint8_t>(bytes.back() | 1U << (child & 7));
    }
  }
  return bytes;
}

Result<Cloud> decode_octree(const std::vector<std::uint8_t>& bytes, std::size_t max_points) {
  Header header;
  if (bytes.size() < sizeof header) return fail("octree stream of {} bytes is cut short", bytes.size());
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.magic != kMagic || header.depth < kMinDepth || header.depth > kMaxDepth)
    return fail("not an octree cloud of liloc::encode");
  if (header.leaves == 0 || header.leaves > max_points)
    return fail("octree stream claims {} points, must be 1..{}", header.leaves, max_points);
  if (!(header.side_m > 0) || header.side_m > 2 * kMaxCoordinate_m)
    return fail("octree stream: side is {} m, must be 0..{}", header.side_m, 2 * kMaxCoordinate_m);

  std::size_t at = sizeof header;
  std::vector<std::uint64_t> nodes = {0}, children;
  for (std::uint32_t level = 0; level < header.depth; ++level, nodes.swap(children)) {
    children.clear();
    for (const auto node : nodes) {
      if (at == bytes.size()) return fail("octree stream of {} bytes is cut short", bytes.size());
      const unsigned occupied = bytes[at++];
      for (std::uint64_t child = 0; child < 8; ++child)
        if (occupied >> child & 1) children.push_back(node << 3 | child);
      if (children.size() > header.leaves) return fail("octree stream is damaged: more leaves than it claims");
    }
  }
  if (nodes.size() != header.leaves || at != bytes.size())
    return fail("octree stream is damaged: {} leaves for {} claimed", nodes.size(), header.leaves);

  const int depth = static_cast<int>(header.depth);
  const float cell_m = header.side_m / static_cast<float>(1 << depth);
  const Eigen::Map<const Eigen::Vector3f> corner(header.corner_m.data());
  Cloud cloud;
  cloud.points.reserve(nodes.size());
  for (const auto leaf : nodes) {
    const Eigen::Vector3f cell = cell_of_morton(leaf, depth).cast<float>();
    cloud.points.emplace_back(corner + (cell.array() + 0.5F).matrix() * cell_m);
  }
  return cloud;
}

}  // namespace liloc::codec
