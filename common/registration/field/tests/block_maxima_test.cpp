#include "common/registration/field/block_maxima.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

class BlockMaximaLaw : public testing::TestWithParam<unsigned> {};

TEST_P(BlockMaximaLaw, AMaximumIsTheGreatestCellOfItsBlockOrOfAStepBeside) {
  const WatchedRoom w = watched_room(GetParam());
  const ScoreField& field = w.target->field_coarse().regions().front();
  const BlockMaxima maxima(field, 16);
  for (int plane = 0; plane < ScoreField::kDirections; ++plane)
    for (int z = 0; z < field.size().z(); z += 3)
      for (int y = 0; y < field.size().y(); ++y)
        for (int x = 4 - field.pad(); x <= field.size().x(); x += 3) {
          const std::int8_t* row = field.row(y, z, plane) + x;
          const int maximum = maxima.column(x, z, plane)[y];
          ASSERT_GE(maximum, *std::max_element(row, row + 16));
          ASSERT_LE(maximum, *std::max_element(row - 3, row + 20));
        }
}

INSTANTIATE_TEST_SUITE_P(Seeds, BlockMaximaLaw, testing::Range(1U, 6U));

}  // namespace
}  // namespace liloc
