#include "common/registration/refine/plane_pairs.hpp"

#include <gtest/gtest.h>

#include "common/testing/small_motion.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

class PlanePairsLaw : public testing::TestWithParam<unsigned> {};

TEST_P(PlanePairsLaw, PairsEightAtATimeAreThePairsOneByOne) {
  const WatchedRoom w = watched_room(GetParam());
  const Side side{w.target->cloud, w.target->nearest, w.query.medium};
  const Pose T = w.T_map_device * small_motion(GetParam(), radians(2), 0.05);
  PlanePairs pairs(side);
  for (const double distance_m : {0.2, 0.06}) {
    NormalEquations expected;
    for_each_pair(side, T, distance_m, 0.5,
                  [&](std::size_t, const Eigen::Vector3f& arm, const Eigen::Vector3f& normal,
                      const Eigen::Vector3f& offset, double weight) {
                    const Vector6d jacobian = jacobian_of(arm, normal);
                    const auto residual = static_cast<double>(normal.dot(offset));
                    expected.H += weight * jacobian * jacobian.transpose();
                    expected.g += weight * residual * jacobian;
                    expected.squared += weight * residual * residual;
                    expected.weight += weight;
                    ++expected.pairs;
                  });
    const NormalEquations got = pairs.at(T, distance_m, 0.5);
    ASSERT_GT(expected.pairs, 50);
    EXPECT_LE(std::abs(got.pairs - expected.pairs), 2) << "of those at the very limit";
    EXPECT_LT((got.H - expected.H).norm(), 2e-3 * expected.H.norm());
    EXPECT_LT((got.g - expected.g).norm(), 2e-3 * expected.H.norm() * distance_m);
    EXPECT_NEAR(got.squared, expected.squared, 5e-3 * expected.squared);
    EXPECT_NEAR(got.weight, expected.weight, 2e-3 * expected.weight);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, PlanePairsLaw, testing::Range(1U, 9U));

}  // namespace
}  // namespace liloc
