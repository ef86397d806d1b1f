#include "common/codec/voxel.hpp"

#include <bit>
#include <cmath>
#include <cstring>

#include "common/codec/voxel_model.hpp"

namespace liloc::codec {
namespace {

static_assert(std::endian::native == std::endian::little, "the header is copied as it lies in memory");

struct Header {
  std::array<std::uint8_t, 4> magic = {'L', 'V', 'X', '1'};
  float voxel_size_m = 0;
  std::uint32_t points = 0;
  std::array<std::int32_t, 3> corner{};  ///< the cell of octree cell 0, 0, 0
  std::uint16_t depth = 0, steps = 0;
};
static_assert(sizeof(Header) == 28);

struct Item {
  CellId leaf = 0;
  Offset offset{};
  bool operator<(const Item& other) const { return leaf < other.leaf; }
};

Eigen::Array3i cell_of_point(const Eigen::Vector3f& p, double voxel_size_m) {
  return (p.cast<double>() / voxel_size_m).array().floor().cast<int>();
}

/// The points by leaf; fills the header's corner and depth.
Result<std::vector<Item>> sorted_items(const Cloud& cloud, Header& header) {
  const double size = static_cast<double>(header.voxel_size_m);
  Eigen::Array3i low = cell_of_point(cloud.points.front(), size), high = low;
  for (const auto& p : cloud.points) {
    low = low.min(cell_of_point(p, size));
    high = high.max(cell_of_point(p, size));
  }
  Eigen::Map<Eigen::Array3i>(header.corner.data()) = low;
  header.depth = static_cast<std::uint16_t>(std::bit_width(static_cast<unsigned>((high - low).maxCoeff())));
  if (header.depth > kMaxDepth)
    return fail("cloud to encode spans {} voxels of {} m, at most {} travel; use a larger voxel",
                (high - low).maxCoeff() + 1, size, 1 << kMaxDepth);
  std::vector<Item> items;
  items.reserve(cloud.size());
  for (const auto& p : cloud.points) {
    const Eigen::Array3d scaled = (p.cast<double>() / size).array(), cell = scaled.floor();
    const Eigen::Array3i step = ((scaled - cell) * header.steps).cast<int>().min(header.steps - 1);
    const Eigen::Array3i at = cell.cast<int>() - low;
    items.push_back({cell_id(static_cast<std::uint64_t>(at.x()), static_cast<std::uint64_t>(at.y()),
                             static_cast<std::uint64_t>(at.z())),
                     {static_cast<std::uint8_t>(step.x()), static_cast<std::uint8_t>(step.y()),
                      static_cast<std::uint8_t>(step.z())}});
  }
  std::stable_sort(items.begin(), items.end());
  return items;
}

struct Level {
  std::vector<CellId> cells;
  std::vector<std::uint8_t> masks;
};

Level level_above(const std::vector<CellId>& cells) {
  std::vector<std::uint64_t> family;  // parent and octant
  family.reserve(cells.size());
  for (const CellId cell : cells) family.push_back(parent_of(cell) << 3 | octant_of(cell));
  std::sort(family.begin(), family.end());
  Level level;
  for (const std::uint64_t member : family) {
    if (level.cells.empty() || level.cells.back() != member >> 3) {
      level.cells.push_back(member >> 3);
      level.masks.push_back(0);
    }
    level.masks.back() = static_cast<std::uint8_t>(level.masks.back() | 1U << (member & 7));
  }
  return level;
}

Result<Header> read_header(const std::vector<std::uint8_t>& bytes, std::size_t max_points) {
  Header header;
  const Header ours;
  if (bytes.size() < sizeof header) return fail("voxel stream of {} bytes is cut short", bytes.size());
  std::memcpy(&header, bytes.data(), sizeof header);
  if (header.magic != ours.magic || header.depth > kMaxDepth || header.steps < 1 || header.steps > kMaxSteps)
    return fail("not a voxel cloud of liloc::encode");
  if (header.points == 0 || header.points > max_points)
    return fail("voxel stream claims {} points, must be 1..{}", header.points, max_points);
  if (!(header.voxel_size_m >= 0.005F && header.voxel_size_m <= 2.0F))
    return fail("voxel stream: voxel is {} m, must be 0.005..2", header.voxel_size_m);
  for (const std::int32_t c : header.corner)
    if (std::abs(static_cast<std::int64_t>(c)) > 1 << kMaxDepth)
      return fail("voxel stream: corner is at cell {}, must be within {}", c, 1 << kMaxDepth);
  return header;
}

Result<std::vector<CellId>> decode_leaves(RangeDecoder& decoder, const Header& header) {
  const auto occupancy = std::make_unique<OccupancyModel>();
  Level level{{cell_id(0, 0, 0)}, {}};
  for (int above = header.depth - 1; above >= 0; --above) {
    level.masks.assign(level.cells.size(), 0);
    occupancy->code(decoder, level.cells, level.masks, above);
    level.cells = children_of(level.cells, level.masks);
    if (decoder.cut_short()) return fail("voxel stream is cut short");
    if (level.cells.size() > header.points) return fail("voxel stream is damaged: more voxels than points");
  }
  return std::move(level.cells);
}

}  // namespace

Result<std::vector<std::uint8_t>> encode_voxel(const Cloud& cloud, double voxel_size_m, int steps) {
  Header header;
  header.voxel_size_m = static_cast<float>(voxel_size_m);
  header.points = static_cast<std::uint32_t>(cloud.size());
  header.steps = static_cast<std::uint16_t>(steps);
  const auto items = sorted_items(cloud, header);
  if (!items) return tl::unexpected(items.error());

  std::vector<CellId> leaves;
  leaves.reserve(items->size());
  for (const Item& item : *items)
    if (leaves.empty() || leaves.back() != item.leaf) leaves.push_back(item.leaf);
  std::vector<Level> levels;  // the leaves' parents first
  for (int i = 0; i < header.depth; ++i) levels.push_back(level_above(i == 0 ? leaves : levels.back().cells));

  RangeEncoder encoder;
  const auto occupancy = std::make_unique<OccupancyModel>();
  for (std::size_t i = levels.size(); i > 0; --i)
    occupancy->code(encoder, levels[i - 1].cells, levels[i - 1].masks, static_cast<int>(i - 1));
  const auto model = std::make_unique<OffsetModel>(steps);
  Foresight foresight(leaves, steps);
  std::vector<Offset> offsets(leaves.size());
  auto item = items->begin();
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    offsets[i] = item->offset;
    const auto foretold = foresight(i, offsets);
    do model->code(encoder, foretold, item->offset);
    while (++item, model->code_again(encoder, item != items->end() && item->leaf == leaves[i]));
  }
  const std::vector<std::uint8_t> stream = encoder.finish();
  std::vector<std::uint8_t> bytes(sizeof header + stream.size());
  std::memcpy(bytes.data(), &header, sizeof header);
  std::copy(stream.begin(), stream.end(), bytes.begin() + sizeof header);
  return bytes;
}

Result<Cloud> decode_voxel(const std::vector<std::uint8_t>& bytes, std::size_t max_points) {
  const auto header = read_header(bytes, max_points);
  if (!header) return tl::unexpected(header.error());
  RangeDecoder decoder(bytes.data() + sizeof(Header), bytes.data() + bytes.size());
  const auto leaves = decode_leaves(decoder, *header);
  if (!leaves) return tl::unexpected(leaves.error());

  const double size = static_cast<double>(header->voxel_size_m), step = 1.0 / header->steps;
  const auto model = std::make_unique<OffsetModel>(header->steps);
  Foresight foresight(*leaves, header->steps);
  std::vector<Offset> offsets(leaves->size());
  Cloud cloud;
  cloud.points.reserve(header->points);
  for (std::size_t i = 0; i < leaves->size(); ++i) {
    const auto foretold = foresight(i, offsets);
    bool again = true;
    for (bool first = true; again; first = false) {
      if (cloud.size() == header->points || decoder.cut_short())
        return fail("voxel stream is damaged: it does not end with its {} points", header->points);
      const Offset offset = model->code(decoder, foretold, {});
      if (first) offsets[i] = offset;
      const auto metres = [&](int axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double cell = static_cast<double>(coordinate((*leaves)[i], axis)) + header->corner[a];
        return static_cast<float>((cell + (offset[a] + 0.5) * step) * size);
      };
      cloud.points.emplace_back(metres(0), metres(1), metres(2));
      again = model->code_again(decoder, false);
    }
  }
  if (cloud.size() != header->points || !decoder.used_up())
    return fail("voxel stream is damaged: it does not end with its {} points", header->points);
  return cloud;
}

}  // namespace liloc::codec
