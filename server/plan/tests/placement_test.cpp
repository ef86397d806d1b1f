#include "server/plan/placement.hpp"

#include <gmock/gmock.h>

#include "server/plan/evaluation.hpp"
#include "server/plan/study.hpp"
#include "server/plan/tests/scanned_room.hpp"

namespace liloc::plan {
namespace {

/// One room with a device's views, and LiDARs placed in it by numbers.
class PlacementLaw : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    room_.emplace(VoxelRoom::create(test::scan_of_two_rooms()).value());
    floor_ = find_free_floor(*room_, test::few_places()).value();
    devices_ = look_around(*room_, floor_, test::small_device(), [](double) {});
  }
  static PlacementOptions options(int lidars) {
    PlacementOptions o;
    o.lidars = lidars;
    o.mounts.ceiling_z_m = 3;
    o.mounts.most = 200;
    return o;
  }
  static std::vector<Mount> placed(const PlacementOptions& o) {
    return place_lidars(*room_, floor_, devices_, {scene::small_camera()}, o, [](double) {}).value();
  }
  static std::vector<HungLidar> hung(const std::vector<Mount>& mounts) {
    std::vector<HungLidar> lidars;
    for (const Mount& mount : mounts)
      lidars.push_back({"lidar", scene::small_camera(), kLidarRange_m, mount.T_map_sensor()});
    return lidars;
  }
  static Evaluation worth(const std::vector<Mount>& mounts) {
    return evaluate(*room_, floor_, devices_, hung(mounts));
  }

  inline static std::optional<VoxelRoom> room_;
  inline static FreeFloor floor_;
  inline static DeviceViews devices_;
};

TEST_F(PlacementLaw, MoreLidarsAreWorthMore) {
  double before = 0;
  for (const int lidars : {1, 2, 4}) {
    const auto mounts = placed(options(lidars));
    ASSERT_EQ(mounts.size(), static_cast<std::size_t>(lidars));
    const double now = worth(mounts).localizable;
    EXPECT_GE(now, before);
    before = now;
  }
}

TEST_F(PlacementLaw, BothRoomsGetALidar) {
  int left = 0;
  const auto mounts = placed(options(4));
  for (const Mount& mount : mounts) left += mount.at_map.x() < 4.5 ? 1 : 0;
  EXPECT_GT(left, 0);
  EXPECT_LT(left, 4);
}

TEST_F(PlacementLaw, BeatsDrawnPlacesAndTheSearchesBeforeIt) {
  PlacementOptions greedy = options(3);
  greedy.swap_rounds = greedy.move_rounds = 0;
  PlacementOptions swapped = options(3);
  swapped.move_rounds = 0;
  const double by_greed = worth(placed(greedy)).localizable, by_swaps = worth(placed(swapped)).localizable,
               by_all = worth(placed(options(3))).localizable;
  EXPECT_GE(by_swaps, by_greed);
  EXPECT_GE(by_all, by_swaps);
  const auto drawn = possible_mounts(*room_, floor_, options(3).mounts);
  for (std::size_t i = 0; i + 3 <= 30; i += 3)
    EXPECT_GT(by_all, worth({drawn[i], drawn[i + 1], drawn[i + 2]}).localizable);
}

TEST_F(PlacementLaw, ASeedGivesTheSamePlan) {
  const auto first = placed(options(2)), again = placed(options(2));
  for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(first[i].T_map_sensor().isApprox(again[i].T_map_sensor()));
}

TEST_F(PlacementLaw, WhereNothingCanHangIsNamed) {
  PlacementOptions o = options(1);
  o.mounts.ceiling_z_m = 9;
  const auto mounts = place_lidars(*room_, floor_, devices_, {scene::small_camera()}, o, [](double) {});
  ASSERT_FALSE(mounts);
  EXPECT_THAT(mounts.error().message, testing::HasSubstr("--height"));
}

TEST_F(PlacementLaw, AnEvaluationAddsUp) {
  const auto mounts = placed(options(3));
  const Evaluation e = worth(mounts);
  double hits = 0;
  for (std::size_t i = 0; i < e.lidars.size(); ++i) {
    hits += e.lidars[i].hit_rate;
    std::vector<Mount> others = mounts;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_NEAR(e.localizable - worth(others).localizable, e.lidars[i].lost, 1e-9);
    EXPECT_LE(e.lidars[i].coverage, e.coverage + 1e-12);
  }
  EXPECT_NEAR(hits, 1, 1e-9);
  EXPECT_NEAR(static_cast<double>(std::count(e.covered.begin(), e.covered.end(), true)),
              e.coverage * static_cast<double>(room_->voxels()), 0.5);
  EXPECT_GE(e.blind_m2, 0);
  EXPECT_LE(e.blind_m2, floor_.area_m2);
  EXPECT_EQ(worth(mounts).localizable, e.localizable);
}

TEST_F(PlacementLaw, WithoutLidarsAllIsBlind) {
  const Evaluation e = worth({});
  EXPECT_EQ(e.coverage, 0);
  EXPECT_NEAR(e.blind_m2, floor_.area_m2, 1e-9);
}

TEST_F(PlacementLaw, TheStudyIsOfTheSiteAsItHangs) {
  const auto mounts = placed(options(3));
  const Evaluation e = worth(mounts);
  const Study study = study_placement(*room_, floor_, devices_, hung(mounts), [](double) {});
  ASSERT_FALSE(study.heights.empty());
  EXPECT_NEAR(study.heights.back().coverage, e.coverage, 1e-12);
  EXPECT_NEAR(study.heights.back().localizable, e.localizable, 1e-12);
  ASSERT_EQ(study.tilts.size(), 5U);
  for (const TiltRow& row : study.tilts) EXPECT_TRUE(row.overlap > 0 && row.overlap <= 1) << row.down_deg;
  EXPECT_GT(study.tilts.front().overlap, study.tilts.back().overlap) << "steep views are small";
  ASSERT_EQ(study.counts.size(), 3U);
  EXPECT_NEAR(study.counts.back().mean, e.coverage, 1e-9);
  for (std::size_t i = 0; i + 1 < study.counts.size(); ++i)
    EXPECT_LE(study.counts[i].mean, study.counts[i + 1].mean);
}

}  // namespace
}  // namespace liloc::plan
