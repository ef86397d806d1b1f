#include "common/learned/voxel_set.hpp"

#include <gmock/gmock.h>

#include <map>
#include <set>

#include "common/learned/morton.hpp"
#include "common/learned/tests/random_network.hpp"

namespace liloc::learned {
namespace {

struct Lexicographic {
  bool operator()(const Eigen::Vector3i& a, const Eigen::Vector3i& b) const {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  }
};
using Set = std::set<Eigen::Vector3i, Lexicographic>;

int floor_half(int v) {
  return v >= 0 ? v / 2 : -((1 - v) / 2);
}

TEST(Morton, DecodesWhatItCoded) {
  for (const std::uint32_t v : {0U, 1U, 2U, 0x155555U, 0x1fffffU}) {
    const Morton m = morton_decoded(morton_code({v, v / 3, 0x1fffff - v}));
    EXPECT_EQ(m.x, v);
    EXPECT_EQ(m.y, v / 3);
    EXPECT_EQ(m.z, 0x1fffff - v);
  }
}

class VoxelSetLaw : public testing::TestWithParam<std::uint64_t> {
 protected:
  const std::vector<Eigen::Vector3i> voxels = random_voxels(GetParam(), 9, 1500);
  const Set expected{voxels.begin(), voxels.end()};
  const VoxelSet set = *VoxelSet::of(voxels);
};

TEST_P(VoxelSetLaw, HoldsEachVoxelOnce) {
  ASSERT_EQ(set.size(), expected.size());
  Set seen;
  for (std::size_t row = 0; row < set.size(); ++row) {
    seen.insert(set.voxel(row));
    EXPECT_EQ(set.find(set.voxel(row)), static_cast<std::int32_t>(row));
  }
  EXPECT_TRUE(std::ranges::equal(seen, expected));
}

TEST_P(VoxelSetLaw, FindsNothingElse) {
  for (int x = -11; x < 11; ++x)
    for (int y = -11; y < 11; ++y)
      for (int z = -11; z < 11; ++z)
        EXPECT_EQ(set.find({x, y, z}) >= 0, expected.contains(Eigen::Vector3i(x, y, z)));
}

TEST_P(VoxelSetLaw, HalvingRoundsDown) {
  const VoxelSet half = set.halved();
  Set halves, seen;
  for (const Eigen::Vector3i& v : expected) halves.insert(v.unaryExpr(&floor_half));
  for (std::size_t row = 0; row < half.size(); ++row) seen.insert(half.voxel(row));
  EXPECT_EQ(half.size(), halves.size());
  EXPECT_TRUE(std::ranges::equal(seen, halves));
}

TEST_P(VoxelSetLaw, NeighborsAreThoseOfTheCube) {
  const VoxelSet half = set.halved();
  for (const auto& [of, scale, radius] :
       {std::tuple{&set, 1, 0}, std::tuple{&set, 1, 1}, std::tuple{&set, 1, 3}, std::tuple{&half, 2, 1}}) {
    VoxelNeighbors neighbors(set);
    const int width = 2 * radius + 1;
    for (std::size_t row = 0; row < of->size(); row += 7) {
      std::map<std::uint32_t, std::uint32_t> wanted, found;
      for (int k = 0; k < width * width * width; ++k) {
        const Eigen::Vector3i offset(k % width - radius, k / width % width - radius,
                                     k / width / width - radius);
        if (const std::int32_t at = set.find(scale * of->voxel(row) + offset); at >= 0)
          wanted[static_cast<std::uint32_t>(k)] = static_cast<std::uint32_t>(at);
      }
      std::vector<VoxelNeighbors::Neighbor> list;
      neighbors.around(*of, row, scale, radius, &list);
      for (const auto& n : list) found[n.offset] = n.row;
      EXPECT_EQ(list.size(), found.size());
      EXPECT_EQ(found, wanted) << "row " << row << ", radius " << radius << ", scale " << scale;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, VoxelSetLaw, testing::Range<std::uint64_t>(1, 5));

TEST(VoxelSet, EmptyHasNothing) {
  const auto set = VoxelSet::of({});
  ASSERT_TRUE(set);
  EXPECT_EQ(set->size(), 0U);
  EXPECT_EQ(set->halved().size(), 0U);
  EXPECT_EQ(set->find({0, 0, 0}), -1);
}

TEST(VoxelSet, MoreThanTheMemoryOfTwoGigabytesAreRefused) {
  const auto block = [](int side) {
    std::vector<Eigen::Vector3i> voxels;
    for (int i = 0; i < side * side * side; ++i)
      voxels.emplace_back(i % side, i / side % side, i / side / side);
    return VoxelSet::of(voxels);
  };
  EXPECT_TRUE(block(73)) << "389 017 voxels";
  const auto refused = block(74);
  ASSERT_FALSE(refused) << "405 224 voxels";
  EXPECT_THAT(refused.error().message, testing::HasSubstr("give larger voxels"));
}

TEST(VoxelSet, ReachesFarAndNoFarther) {
  const int far = VoxelSet::kReach;
  const auto set = VoxelSet::of({{far, -far, 0}, {0, 0, far}});
  ASSERT_TRUE(set);
  EXPECT_GE(set->find({far, -far, 0}), 0);
  EXPECT_EQ(set->find({1 << 30, -(1 << 30), 0}), -1);
  VoxelNeighbors neighbors(*set);
  std::vector<VoxelNeighbors::Neighbor> found;
  neighbors.around(*set, 0, 1, 3, &found);
  EXPECT_EQ(found.size(), 1U) << "itself alone";
  const auto beyond = VoxelSet::of({{0, far + 1, 0}});
  ASSERT_FALSE(beyond);
  EXPECT_THAT(beyond.error().message, testing::HasSubstr("out of reach"));
}

}  // namespace
}  // namespace liloc::learned
