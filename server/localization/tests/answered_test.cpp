#include "server/localization/answered.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "server/localization/tests/world.hpp"

namespace liloc {
namespace {

class Passer : public testing::TestWithParam<unsigned> {
 protected:
  Passer() : world_(GetParam()), session_({}) { world_.watch(0); }

  /// The device stands; `passes`: somebody is half-way between it and what is straight ahead.
  [[nodiscard]] SpotRequest seen(int at, bool passes) const {
    SpotRequest request = world_.request(0, world_.truth(0));
    request.stamp_ns += at * from_ms(25);
    if (!passes) return request;
    Cloud cloud = *decode(request.lpc);
    for (Eigen::Vector3f& p : cloud.points)
      if (std::abs(p.x()) < 0.15F * p.z()) p *= 0.5F;
    request.lpc = *encode(cloud);
    return request;
  }
  [[nodiscard]] std::shared_ptr<const Spot> spot(const SpotRequest& request,
                                                 const LocalizerOptions& options = {}) {
    return spot_of(session_, request, world_.cloud->nearest(request.stamp_ns).value(), options).value();
  }

  World world_;
  DeviceSession session_;
};

TEST_P(Passer, IsLeftOutOfTheCloudAndStillSeen) {
  EXPECT_TRUE(spot(seen(0, false))->moving().empty());
  const auto before = spot(seen(1, false));
  EXPECT_TRUE(before->moving().empty()) << "nothing moves";
  const SpotRequest request = seen(2, true);
  const auto with = spot(request);
  const Cloud cloud = *decode(request.lpc);
  ASSERT_GT(with->moving().size(), 50U);
  for (const std::uint32_t i : with->moving()) {
    const Eigen::Vector3f& p = cloud.points[i];
    EXPECT_LT(std::abs(p.x()), 0.16F * p.z());
    EXPECT_NE(with->query().view.look_sensor(p, 0.05F), Sight::conflict) << "he is seen, not looked through";
    EXPECT_NE(with->query().view.look_sensor(1.8F * p, 0.05F), Sight::conflict) << "nor what he hides";
    for (const Eigen::Vector3f& q : with->query().cloud.points) EXPECT_GT((p - q).norm(), 1e-3F);
  }
}

TEST_P(Passer, CountsWhereARequestStandsAloneAndForThePapersMethods) {
  (void)spot(seen(0, false));
  SpotRequest cold = seen(1, true);
  cold.cold = true;
  EXPECT_TRUE(spot(cold)->moving().empty());
  LocalizerOptions paper;
  paper.method = Method::paper;
  EXPECT_TRUE(spot(seen(2, true), paper)->moving().empty());
  EXPECT_FALSE(spot(seen(3, true))->moving().empty());
}

/// Odometry that slips moves the whole room: what contradicts it must count.
TEST_P(Passer, CountsWhereOdometryIsWhatAPoseRestsOn) {
  DeviceSession::Segment followed{seen(0, false).odom_segment};
  followed.followed.emplace();
  DeviceSession session({}, followed);
  const auto moving = [&](const SpotRequest& request) {
    return spot_of(session, request, world_.cloud->nearest(request.stamp_ns).value(), {}).value()->moving();
  };
  (void)moving(seen(0, false));
  EXPECT_TRUE(moving(seen(1, true)).empty());
  (void)moving(seen(2, false));
  SpotRequest other = seen(3, false);
  other.odom_segment += 1;
  (void)moving(other);
  other = seen(4, true);
  other.odom_segment += 1;
  EXPECT_FALSE(moving(other).empty()) << "of a new segment nothing is followed yet";
}

INSTANTIATE_TEST_SUITE_P(Seeds, Passer, testing::Range(1U, 4U));

}  // namespace
}  // namespace liloc
