#include "common/registration/sight/map_points.hpp"

#include <gtest/gtest.h>

#include <random>

#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

TEST(MapPoints, RunsThatArePassedOverHoldNothingInView) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const WatchedRoom w = watched_room(seed);
    const std::vector<Eigen::Vector3f>& all = w.target->coarse.points;
    std::vector<Eigen::Vector3f> sound, stale, every_other;
    for (std::size_t i = 0; i < all.size(); ++i) {
      (i % 7 == 0 ? stale : sound).push_back(all[i]);
      if (i % 2 == 0) every_other.push_back(all[i]);
    }
    const auto count = [&](const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3f& T) {
      return w.query.view.tally(Vectors(points).run(0, points.size()), T, 0.05F);
    };
    std::mt19937_64 rng(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    int agree = 0;
    for (int trial = 0; trial < 50; ++trial) {
      Pose T_map_device = w.T_map_device;
      T_map_device.linear() =
          so3_exp(3 * Eigen::Vector3d(unit(rng), unit(rng), unit(rng))) * T_map_device.linear();
      T_map_device.translation() += 2 * Eigen::Vector3d(unit(rng), unit(rng), unit(rng));
      const Eigen::Isometry3f T = T_map_device.inverse().cast<float>();
      const SightView::Tally in_doubt = MapPoints(sound, stale).seen_by(w.query.view, T, 0.05F, MapShare::all),
                             half = MapPoints(all).seen_by(w.query.view, T, 0.05F, MapShare::half);
      EXPECT_EQ(in_doubt.agree, count(all, T).agree);
      EXPECT_EQ(in_doubt.conflict, count(sound, T).conflict);
      EXPECT_EQ(half.agree, count(every_other, T).agree);
      EXPECT_EQ(half.conflict, count(every_other, T).conflict);
      agree += half.agree;
    }
    EXPECT_GT(agree, 100);
  }
}

}  // namespace
}  // namespace liloc
