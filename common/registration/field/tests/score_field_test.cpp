#include "common/registration/field/score_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

class ScoreFieldLaw : public testing::TestWithParam<unsigned> {};

TEST_P(ScoreFieldLaw, ManyProbesAreWorthWhatEachIs) {
  const WatchedRoom w = watched_room(GetParam());
  const ScoreField& field = w.target->field_fine().regions().front();
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

TEST_P(ScoreFieldLaw, APlaneIsTheOctantThatANormalPointsTo) {
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

TEST_P(ScoreFieldLaw, SurfacesCountOnlyWhereTheyFaceTheSameWay) {
  const WatchedRoom w = watched_room(GetParam());
  const ScoreField& field = w.target->field_fine().regions().front();
  int same = 0, opposite = 0;
  for (std::size_t i = 0; i < w.target->coarse.size(); i += 7) {
    const Eigen::Vector3f& p = w.target->coarse.points[i];
    const Eigen::Vector3f& n = w.target->coarse.normals[i];
    same += field.at(p, ScoreField::plane_of(n)) > 0;
    opposite += field.at(p, ScoreField::plane_of(-n)) > 0;
  }
  EXPECT_GT(same, 20 * opposite);
}

TEST_P(ScoreFieldLaw, FloorIsWorthLessThanWalls) {
  const WatchedRoom w = watched_room(GetParam());
  const ScoreField& field = w.target->field_coarse().regions().front();
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

INSTANTIATE_TEST_SUITE_P(Seeds, ScoreFieldLaw, testing::Range(1U, 6U));

}  // namespace
}  // namespace liloc
