#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "common/registration/field/climber.hpp"
#include "common/registration/field/row_sums.hpp"
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

class FieldLaw : public testing::TestWithParam<unsigned> {};

TEST_P(FieldLaw, RowsAddUpToWhatPlacesScoreOneByOne) {
  const WatchedRoom w = watched_room(GetParam());
  const ScoreField& field = w.target->field_coarse();
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

TEST_P(FieldLaw, SumsAboveAThresholdAreFoundAndExact) {
  const WatchedRoom w = watched_room(GetParam());
  const ScoreField& field = w.target->field_coarse();
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

TEST_P(FieldLaw, AMaximumIsTheGreatestCellOfItsBlockOrOfAStepBeside) {
  const WatchedRoom w = watched_room(GetParam());
  const ScoreField& field = w.target->field_coarse();
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

TEST_P(FieldLaw, ManyProbesAreWorthWhatEachIs) {
  const WatchedRoom w = watched_room(GetParam());
  const ScoreField& field = w.target->field_fine();
  const Eigen::Vector3f shift(0.31F, -0.17F, 0.05F);
  ScoreField::Probes probes;
  std::mt19937_64 rng(GetParam());
  std::uniform_real_distribution<float> anywhere(-2, 8);  // some of it outside of the room
  for (int i = 0; i < 8003; ++i) {
    probes.x.push_back(anywhere(rng));
    probes.y.push_back(anywhere(rng));
    probes.z.push_back(anywhere(rng));
    probes.plane.push_back(static_cast<int>(rng() % ScoreField::kDirections));
  }
  std::vector<std::int32_t> worths(8001);
  field.look_up(probes, shift, worths);
  for (std::size_t i = 0; i < worths.size(); ++i)
    ASSERT_EQ(worths[i],
              field.at(Eigen::Vector3f(probes.x[i], probes.y[i], probes.z[i]) + shift, probes.plane[i]));
  EXPECT_GT(std::count_if(worths.begin(), worths.end(), [](int v) { return v != 0; }), 50);
}

TEST_P(FieldLaw, APlaneIsTheOctantThatANormalPointsTo) {
  std::mt19937_64 rng(GetParam());
  std::normal_distribution<float> unit(0, 1);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3f n = Eigen::Vector3f(unit(rng), unit(rng), unit(rng)).normalized();
    const int plane = ScoreField::plane_of(n);
    if (std::abs(n.z()) > 0.7F) {
      EXPECT_EQ(plane, n.z() > 0 ? ScoreField::kUp : ScoreField::kDown);
      continue;
    }
    const long octant = std::lround(std::atan2(n.y(), n.x()) / (M_PI / 4));
    EXPECT_EQ(plane, (octant + ScoreField::kAzimuths) % ScoreField::kAzimuths);
  }
}

TEST_P(FieldLaw, SurfacesCountOnlyWhereTheyFaceTheSameWay) {
  const WatchedRoom w = watched_room(GetParam());
  const ScoreField& field = w.target->field_fine();
  int same = 0, opposite = 0;
  for (std::size_t i = 0; i < w.target->coarse.size(); i += 7) {
    const Eigen::Vector3f& p = w.target->coarse.points[i];
    const Eigen::Vector3f& n = w.target->coarse.normals[i];
    same += field.at(p, ScoreField::plane_of(n)) > 0;
    opposite += field.at(p, ScoreField::plane_of(-n)) > 0;
  }
  EXPECT_GT(same, 20 * opposite);
}

TEST_P(FieldLaw, FloorIsWorthLessThanWalls) {
  const WatchedRoom w = watched_room(GetParam());
  const ScoreField& field = w.target->field_coarse();
  const Eigen::Vector3f up = Eigen::Vector3f::UnitZ();
  int floor = 0, floors = 0, wall = 0, walls = 0;
  for (std::size_t i = 0; i < w.target->coarse.size(); i += 3) {
    const Eigen::Vector3f& p = w.target->coarse.points[i];
    const Eigen::Vector3f& n = w.target->coarse.normals[i];
    const int worth = field.at(p, ScoreField::plane_of(n));
    if (std::abs(p.z()) < 0.03F && n.dot(up) > 0.9F) floor += worth, ++floors;
    if (p.z() > 0.6F && std::abs(n.dot(up)) < 0.2F) wall += worth, ++walls;
  }
  ASSERT_TRUE(floors > 20 && walls > 20);
  EXPECT_LT(2.0 * floor / floors, 1.0 * wall / walls);
}

TEST_P(FieldLaw, WhoeverMovesMakesEmptySpaceUnknownAndLeavesSurfaces) {
  const WatchedRoom w = watched_room(GetParam());
  const ScoreField& field = w.target->field_coarse();
  Eigen::Vector3f empty = Eigen::Vector3f::Zero();
  std::mt19937_64 rng(GetParam());
  std::uniform_real_distribution<float> x(1, 5), y(1, 4), z(0.6F, 2);
  do empty = {x(rng), y(rng), z(rng)};
  while (field.at(empty, ScoreField::kUp) >= 0);
  const DynamicRegions regions(w.target.surfaces, w.target.views, {{empty}, {}});
  EXPECT_TRUE(regions.mask.at(empty));
  EXPECT_FALSE(regions.mask.at(empty + Eigen::Vector3f(1.5F, 0, 0)));
  const ScoreField& masked = regions.field_coarse();
  EXPECT_EQ(masked.at(empty, ScoreField::kUp), 0);
  for (const Eigen::Vector3f& p : w.target->coarse.points)
    ASSERT_EQ(masked.at(p, ScoreField::kAny), field.at(p, ScoreField::kAny));
  EXPECT_EQ(&DynamicRegions(w.target.surfaces, w.target.views, {}).field_coarse(), &field);
}

TEST_P(FieldLaw, ClimbingEndsNearTheDeviceAndNeverLower) {
  const WatchedRoom w = watched_room(GetParam());
  const Eigen::Matrix3d R =
      Eigen::Quaterniond::FromTwoVectors(w.up_device, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Pose level = Pose::Identity();
  level.linear() = R;
  const Cloud points = transformed(level, w.query.sparse);
  Climber climber(w.target->field_fine(), nullptr, Eigen::Vector3d::UnitZ(), points);
  const Eigen::Matrix3d turn = w.T_map_device.linear() * R.transpose();
  const double yaw = std::atan2(turn(1, 0), turn(0, 0));
  Eigen::Vector4d start;
  start << w.T_map_device.translation() + Eigen::Vector3d(0.08, -0.08, 0.06), yaw + radians(2);
  const LevelPose top = climber.climb(start, {});
  EXPECT_LT((top.pose.head<3>() - w.T_map_device.translation()).norm(), 0.25);  // the fine field resolves 0.1 m
  EXPECT_LT(std::abs(std::remainder(top.pose[3] - yaw, 2 * M_PI)), radians(3));
  EXPECT_GE(top.score, climber.climb(start, {0.1, 0.04, 0, 0, 240}).score);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FieldLaw, testing::Range(1U, 6U));

}  // namespace
}  // namespace liloc
