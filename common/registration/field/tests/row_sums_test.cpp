#include "common/registration/field/row_sums.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

std::vector<CellOffset> some_offsets(unsigned seed) {
  std::mt19937_64 rng(seed);
  std::vector<CellOffset> offsets;
  for (int i = 0; i < 61; ++i) {  // not a multiple of eight
    const auto within = [&](int most) { return static_cast<int>(rng() % (2 * most + 1)) - most; };
    offsets.push_back({within(30), within(50), within(10), static_cast<int>(rng() % ScoreField::kDirections)});
  }
  return offsets;
}

constexpr int kLeast = std::numeric_limits<std::int16_t>::min();

class RowSumsLaw : public testing::TestWithParam<unsigned> {};

TEST_P(RowSumsLaw, RowsAddUpToWhatPlacesScoreOneByOne) {
  const WatchedRoom w = watched_room(GetParam());
  const ScoreField& field = w.target->field_coarse().regions().front();
  const std::vector<CellOffset> offsets = some_offsets(GetParam());
  const BlockMaxima maxima(field, RowSums::kBlock);
  RowSums sums(field, maxima);
  sums.take(offsets);
  const auto cell = static_cast<float>(field.cell_m());
  std::vector<std::uint32_t> above;
  for (const int z : {0, 3, field.size().z() - 1}) {
    const auto& got = sums.at_height(z, kLeast, &above);
    for (int y = 0; y < field.size().y(); y += 3)
      for (int x = 0; x < field.size().x(); ++x) {
        int expected = 0;
        for (const CellOffset& o : offsets) {
          const Eigen::Vector3f centre(x + o.x + 0.5F, y + o.y + 0.5F, z + o.z + 0.5F);
          expected += field.at(field.origin() + cell * centre, o.plane);
        }
        ASSERT_EQ(got[static_cast<std::size_t>(y * sums.width() + x)], expected) << x << " " << y << " " << z;
      }
  }
}

TEST_P(RowSumsLaw, SumsAboveAThresholdAreFoundAndExact) {
  const WatchedRoom w = watched_room(GetParam());
  const ScoreField& field = w.target->field_coarse().regions().front();
  const BlockMaxima maxima(field, RowSums::kBlock);
  RowSums sums(field, maxima);
  sums.take(some_offsets(GetParam()));
  std::vector<std::uint32_t> above;
  for (int z = 0; z < field.size().z(); z += 2) {
    const std::vector<std::int16_t> all = sums.at_height(z, kLeast, &above);
    const int most = *std::ranges::max_element(all);
    for (const int threshold : {-100, 0, most / 2, most - 1, most}) {
      const auto& got = sums.at_height(z, threshold, &above);
      std::vector<std::uint32_t> expected;
      for (std::uint32_t i = 0; i < all.size(); ++i) {
        if (all[i] > threshold) expected.push_back(i);
        ASSERT_TRUE(got[i] == all[i] || (got[i] < all[i] && all[i] <= threshold)) << i << " of height " << z;
      }
      EXPECT_EQ(above, expected);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RowSumsLaw, testing::Range(1U, 6U));

}  // namespace
}  // namespace liloc
