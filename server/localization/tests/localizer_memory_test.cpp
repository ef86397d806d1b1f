// What a localizer remembers of devices that leave, come back, or come from another server.
#include <gmock/gmock.h>

#include <chrono>
#include <future>
#include <utility>

#include "server/localization/localizer.hpp"
#include "server/localization/tests/world.hpp"

namespace liloc {
namespace {

class LocalizerMemoryLaw : public testing::TestWithParam<unsigned> {
 protected:
  /// Asks until an answer is verified. What is remembered then.
  Remembered followed(World& world) {
    SpotReply last;
    for (; next_ < 6 && !last.verified(); ++next_) last = world.ask(next_);
    EXPECT_TRUE(last.verified());
    const auto remembered = world.localizer->remembered("robot");
    EXPECT_TRUE(remembered);
    return remembered.value_or(Remembered{});
  }
  int next_ = 0;  ///< spot
};

TEST_P(LocalizerMemoryLaw, IsGoneOnWithByAnotherServer) {
  World before(GetParam()), after(GetParam());
  EXPECT_FALSE(before.localizer->remembered("robot"));
  after.localizer->resume("robot", followed(before), 0.8);
  const SpotReply reply = after.ask(next_);
  EXPECT_EQ(reply.reason, Reason::confirmed) << reply.text;
  ASSERT_TRUE(reply.T_map_sensor);
  EXPECT_TRUE(near(*reply.T_map_sensor, after.truth(next_)));
}

TEST_P(LocalizerMemoryLaw, IsLessSureTheLongerNobodyLooked) {
  World world(GetParam());
  const Remembered before = followed(world);
  double sd_m = before.followed.estimate.sd_m();
  for (const double away_s : {5.0, 50.0}) {
    world.localizer->forget("robot");
    EXPECT_TRUE(world.localizer->remembered("robot")) << "a request may still be in work";
    world.localizer->resume("robot", before, away_s);
    const auto now = world.localizer->remembered("robot");
    ASSERT_TRUE(now);
    EXPECT_LE(now->followed.log_odds, before.followed.log_odds);
    EXPECT_GT(now->followed.estimate.sd_m(), 1.5 * sd_m) << away_s << " s";
    sd_m = now->followed.estimate.sd_m();
  }
}

TEST_P(LocalizerMemoryLaw, IsLeftDuringASearchWithoutAWait) {
  std::promise<void> inside, open;
  LocalizerOptions options;
  options.idle = [&, first = true]() mutable {
    if (std::exchange(first, false)) {
      inside.set_value();
      open.get_future().wait();
    }
    return true;
  };
  World world(GetParam(), options);
  world.watch(0);
  auto reply =
      std::async(std::launch::async, [&] { return world.localizer->locate(world.request(0, world.truth(0))); });
  inside.get_future().wait();
  auto forgotten = std::async(std::launch::async, [&] { world.localizer->forget("robot"); });
  EXPECT_EQ(forgotten.wait_for(std::chrono::seconds(20)), std::future_status::ready);
  open.set_value();
  (void)reply.get();
}

TEST_P(LocalizerMemoryLaw, OfAnotherPlaceIsNotBelieved) {
  World before(GetParam()), after(GetParam());
  Remembered remembered = followed(before);
  remembered.followed.estimate.T_map_sensor.translation().x() += 1.5;
  after.localizer->resume("robot", remembered, 0.8);
  for (int k = next_; k < next_ + 4; ++k) {
    const SpotReply reply = after.ask(k);
    if (!reply.verified()) continue;
    EXPECT_TRUE(near(*reply.T_map_sensor, after.truth(k))) << "spot " << k;
  }
}

TEST_P(LocalizerMemoryLaw, ThatWasForgottenIsSearchedAnew) {
  World world(GetParam());
  (void)followed(world);
  ASSERT_EQ(world.ask(next_).reason, Reason::confirmed);
  world.localizer->forget_all();
  EXPECT_NE(world.ask(next_ + 1).reason, Reason::confirmed) << "the same id and odom segment";
}

INSTANTIATE_TEST_SUITE_P(Seeds, LocalizerMemoryLaw, testing::Range(1U, 6U));

}  // namespace
}  // namespace liloc
