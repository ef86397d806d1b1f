#include "server/localization/localizer.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "common/base/log.hpp"
#include "server/localization/tests/world.hpp"
#include "server/localization/verification.hpp"

namespace liloc {
namespace {

class LocalizerLaw : public testing::TestWithParam<unsigned> {};

TEST_P(LocalizerLaw, AWalkIsVerifiedAndMapToOdomIsRight) {
  World world(GetParam());
  bool verified = false;
  for (int k = 0; k < 6; ++k) {
    const SpotReply reply = world.ask(k);
    ASSERT_TRUE(reply.T_map_sensor) << name_of(reply.reason) << " " << reply.text;
    if (!reply.verified()) continue;
    verified = true;
    EXPECT_TRUE(near(*reply.T_map_sensor, world.truth(k))) << "spot " << k;
    ASSERT_TRUE(reply.T_map_odom);
    EXPECT_TRUE(near(*reply.T_map_odom * world.request(k, world.truth(k)).T_odom_sensor, world.truth(k)));
    EXPECT_EQ(reply.gpc_stamp_ns, kT0 + k * kStep + from_ms(10));
  }
  EXPECT_TRUE(verified);
}

TEST_P(LocalizerLaw, AColdRequestIsAnsweredOnItsOwn) {
  World world(GetParam());
  world.watch(0);
  SpotRequest request = world.request(0, world.truth(0));
  request.cold = true;
  const SpotReply first = world.localizer->locate(request);
  ASSERT_TRUE(first.T_map_sensor);
  EXPECT_TRUE(near(*first.T_map_sensor, world.truth(0)) || (!first.verified() && first.margin < 0.1))
      << name_of(first.reason) << " overlap " << first.overlap << " fitness " << first.fitness << " margin "
      << first.margin << " off " << distance_m(*first.T_map_sensor, world.truth(0)) << " m "
      << degrees(angle_between_rad(*first.T_map_sensor, world.truth(0))) << " deg";
  const SpotReply again = world.localizer->locate(request);
  EXPECT_TRUE(again.T_map_sensor->isApprox(*first.T_map_sensor)) << "nothing is remembered";
  EXPECT_EQ(again.status, first.status);
  ASSERT_EQ(first.T_map_odom.has_value(), first.verified());
  if (!first.verified()) return;
  EXPECT_TRUE((*first.T_map_odom * request.T_odom_sensor).isApprox(*first.T_map_sensor, 1e-9));
}

TEST_P(LocalizerLaw, ADeviceThatWasLiftedElsewhereIsNotBelievedAndFoundAgain) {
  World world(GetParam());
  for (int k = 0; k < 5; ++k) (void)world.ask(k);
  const auto elsewhere = [&](int k) {  // odometry knows nothing of the lift
    return scene::looking({3.6 - 0.1 * k, 3.0, 1.2}, 0.8 * GetParam() + 2.2 + 0.1 * k, radians(12));
  };
  world.T_map_odom = elsewhere(5) * world.truth(5).inverse() * world.T_map_odom;
  std::optional<int> found;
  for (int k = 5; k < 14; ++k) {
    world.watch(k);
    const SpotReply reply = world.localizer->locate(world.request(k, elsewhere(k)));
    if (k == 5) {
      EXPECT_EQ(reply.reason, Reason::weak);
      EXPECT_NE(reply.advice, Advice::none);
      EXPECT_THAT(reply.text, testing::Not(testing::HasSubstr("nothing in the room")))
          << "nobody has looked yet";
    }
    if (!reply.verified()) continue;
    EXPECT_TRUE(near(*reply.T_map_sensor, elsewhere(k)))
        << "spot " << k << " " << name_of(reply.reason) << " overlap " << reply.overlap << " fitness "
        << reply.fitness << " off " << distance_m(*reply.T_map_sensor, elsewhere(k)) << " m "
        << degrees(angle_between_rad(*reply.T_map_sensor, elsewhere(k))) << " deg";
    if (!found && near(*reply.T_map_sensor, elsewhere(k))) found = k;
  }
  ASSERT_TRUE(found);
  EXPECT_LE(*found, 8) << "two spots to notice, the second of which is the first of three that agree";
}

INSTANTIATE_TEST_SUITE_P(Seeds, LocalizerLaw, testing::Range(1U, 6U));

TEST(Localizer, RefusalsSayWhy) {
  World world(1);
  SpotReply reply = world.localizer->locate(world.request(0, world.truth(0)));
  EXPECT_EQ(reply.reason, Reason::no_gpc);
  EXPECT_EQ(reply.status, SpotStatus::refused);
  EXPECT_FALSE(reply.text.empty());
  world.watch(0);
  SpotRequest damaged = world.request(0, world.truth(0));
  damaged.lpc.bytes.resize(damaged.lpc.bytes.size() / 2);
  EXPECT_EQ(world.localizer->locate(damaged).reason, Reason::bad_cloud);
  SpotRequest tiny = world.request(0, world.truth(0));
  Cloud few;
  few.points = {{0, 0, 1}, {0, 0.1F, 1}, {0.1F, 0, 1}};
  tiny.lpc = *encode(few);
  reply = world.localizer->locate(tiny);
  EXPECT_EQ(reply.reason, Reason::bad_cloud);
  EXPECT_THAT(reply.text, testing::HasSubstr("points"));
}

TEST(Localizer, ASearchThatWasCutOffIsNotBelieved) {
  LocalizerOptions options;
  options.search_limit = std::chrono::seconds(0);
  World world(2, options);
  std::vector<std::string> lines;
  log::set_sink([&](log::Level, std::string_view line) { lines.emplace_back(line); });
  for (int k = 0; k < 4; ++k) {
    const SpotReply reply = world.ask(k);
    EXPECT_EQ(reply.status, SpotStatus::refused) << "what it did not reach may look alike";
    EXPECT_EQ(reply.reason, Reason::overloaded);
    EXPECT_THAT(reply.text, testing::HasSubstr("cut off"));
  }
  log::set_sink({});
  EXPECT_THAT(lines, testing::ElementsAre(testing::HasSubstr("cut off after 0.0 s")));
}

TEST(Localizer, ATrackedDevicesRoutineSearchWaitsForSpareTimeButNotForever) {
  bool idle = false;
  LocalizerOptions options;
  options.idle = [&] { return idle; };
  World world(2, options);
  int k = 0;
  const auto ask = [&] {
    world.watch(k);
    const SpotReply reply = world.localizer->locate(world.request(k, world.truth(1)));
    ++k;
    return reply;
  };
  const auto spots_until_searched = [&] {
    int spots = 1;
    for (; spots < 100; ++spots) {
      const SpotReply reply = ask();
      EXPECT_TRUE(reply.verified()) << "spot " << k << " " << name_of(reply.reason);
      if (reply.margin != 0) break;
    }
    return spots;
  };
  while (k < 20 && !ask().verified()) continue;
  EXPECT_EQ(spots_until_searched(), VerifyOptions{}.research_latest);
  idle = true;
  EXPECT_EQ(spots_until_searched(), VerifyOptions{}.research_every);
}

/// Four spots of a walk whose device takes `up_sensor` of the truth for up; how many are right.
int right_spots(World& world, const std::function<void(SpotRequest*)>& spoil, bool* noticed = nullptr) {
  int right = 0;
  for (int k = 0; k < 4; ++k) {
    world.watch(k);
    SpotRequest request = world.request(k, world.truth(k));
    spoil(&request);
    const SpotReply reply = world.localizer->locate(request);
    const bool good = reply.T_map_sensor && near(*reply.T_map_sensor, world.truth(k));
    right += good;
    EXPECT_TRUE(!reply.verified() || good) << "spot " << k;
    if (noticed != nullptr) *noticed |= reply.text.find("gravity is off by") != std::string::npos;
  }
  return right;
}

class GravityLaw : public testing::TestWithParam<unsigned> {};

TEST_P(GravityLaw, TenDegreesWrongIsFoundOutAndDropped) {
  World world(GetParam());
  bool noticed = false;
  EXPECT_GE(right_spots(
                world,
                [](SpotRequest* r) {
                  r->up_sensor = so3_exp({radians(10), 0, 0}) * *r->up_sensor;
                },
                &noticed),
            3);
  EXPECT_TRUE(noticed);
}

TEST_P(GravityLaw, AWallTakenForTheFloorIsFoundOutAndDropped) {
  World world(GetParam());
  bool noticed = false;
  EXPECT_GE(
      right_spots(
          world,
          [](SpotRequest* r) { r->up_sensor = r->up_sensor->cross(Eigen::Vector3d::UnitZ()).normalized(); },
          &noticed),
      3);
  EXPECT_TRUE(noticed);
}

TEST_P(GravityLaw, WithoutAnyPlanesTellUp) {
  World world(GetParam());
  EXPECT_GE(right_spots(world, [](SpotRequest* r) { r->up_sensor.reset(); }), 3);
}

INSTANTIATE_TEST_SUITE_P(Seeds, GravityLaw, testing::Range(1U, 6U));

TEST(Localizer, TheSameRequestsGiveTheSameAnswers) {
  World a(5), b(5);
  for (int k = 0; k < 4; ++k) {
    const SpotReply x = a.ask(k), y = b.ask(k);
    ASSERT_TRUE(x.T_map_sensor && y.T_map_sensor);
    EXPECT_TRUE((x.T_map_sensor->matrix().array() == y.T_map_sensor->matrix().array()).all());
    EXPECT_EQ(x.reason, y.reason);
  }
}

TEST(Localizer, ManyClientsAtOnce) {
  World world(1);
  world.watch(0);
  std::vector<std::jthread> clients;
  for (int c = 0; c < 4; ++c)
    clients.emplace_back([&, c] {
      SpotRequest request = world.request(0, world.truth(0));
      for (int i = 0; i < 3; ++i) {
        request.client_id = "robot" + std::to_string(c);
        request.seq = static_cast<std::uint64_t>(i) + 1;
        const SpotReply reply = world.localizer->locate(request);
        EXPECT_EQ(reply.client_id, request.client_id);
        EXPECT_TRUE(reply.T_map_sensor);
      }
      world.localizer->forget(request.client_id);
    });
}

class PaperMethods : public testing::TestWithParam<const char*> {};

TEST_P(PaperMethods, RunAndAnswer) {
  LocalizerOptions options;
  options.method = *method_from(GetParam());
  World world(2, options);
  int answered = 0;
  for (int k = 0; k < 3; ++k) answered += world.ask(k).T_map_sensor.has_value();
  EXPECT_EQ(answered, 3);
  EXPECT_FALSE(global_cloud_options_for(options).drop_moving) << "the paper's global cloud was raw";
}

INSTANTIATE_TEST_SUITE_P(Paper, PaperMethods,
                         testing::Values("paper", "static-noopt", "dynamic-noopt", "dynamic-nover"));

TEST(Methods, TheVerificationIsChosenApartFromTheSearch) {
  LocalizerOptions options;
  options.verify = Verify::none;
  EXPECT_TRUE(World(2, options).ask(0).verified());
  options.verify = Verify::paper;
  World world(2, options);
  for (int k = 0; k < 3; ++k) {
    const SpotReply reply = world.ask(k);
    EXPECT_EQ(reply.verified(), k == 2) << "three spots are checked against each other";
    EXPECT_TRUE(!reply.verified() || near(*reply.T_map_sensor, world.truth(k)));
  }
}

TEST(Methods, WhatCannotWorkOrIsUnknownIsSaid) {
  LocalizerOptions options;
  EXPECT_TRUE(options.validated());
  options.method = Method::paper;
  EXPECT_TRUE(options.validated());
  options.verify = Verify::tracks;
  EXPECT_THAT(options.validated().error().message, testing::HasSubstr("verify tracks"));
  EXPECT_THAT(method_from("magic").error().message, testing::HasSubstr("dynamic-nover"));
  EXPECT_THAT(verify_from("").error().message, testing::HasSubstr("tracks"));
  EXPECT_THAT(icp_from("plain").error().message, testing::HasSubstr("plane"));
}

struct Variant {
  double voxel_m, sampling;
  Icp icp;
};

TEST(Localizer, VerifiedAnswersTeachWhatFitsAndADeviceThatStandsTeachesOnce) {
  World world(1);
  int verified = 0;
  for (int k = 0; k < 4; ++k) verified += world.ask(k).verified();
  ASSERT_GE(verified, 2);
  const auto count = [&] {
    int sum = 0;
    for (const auto& [at, cell] : world.localizer->learned()->cells()) sum += cell.count;
    return sum;
  };
  const int walked = count();
  EXPECT_GE(walked, 1);
  SpotRequest same = world.request(4, world.truth(3));
  for (int i = 0; i < 3; ++i) {
    world.watch(4 + i);
    same.stamp_ns = kT0 + (4 + i) * kStep;
    same.seq = static_cast<std::uint64_t>(10 + i);
    EXPECT_TRUE(world.localizer->locate(same).verified());
  }
  EXPECT_EQ(count(), walked);
}

TEST(Localizer, ThePaperRefusesWhatNeverFittedSo) {
  CellBounds learned;
  for (double x = -5; x < 12; x += 1)
    for (double y = -5; y < 12; y += 1)
      for (int i = 0; i < CellBounds::kFewest; ++i) learned.learn({x, y, 0}, 0.02);
  LocalizerOptions options;
  options.method = Method::paper;
  const SpotReply known = World(2, options, learned).ask(0), fresh = World(2, options).ask(0);
  EXPECT_EQ(known.reason, Reason::not_found);
  EXPECT_TRUE(fresh.T_map_sensor);
}

class Variants : public testing::TestWithParam<Variant> {};

TEST_P(Variants, FindTheWalk) {
  LocalizerOptions options;
  options.voxel_size_m = GetParam().voxel_m;
  options.sampling = GetParam().sampling;
  options.icp = GetParam().icp;
  World world(3, options);
  int verified = 0;
  for (int k = 0; k < 5; ++k) {
    const SpotReply reply = world.ask(k);
    verified += reply.verified();
    EXPECT_TRUE(!reply.verified() || near(*reply.T_map_sensor, world.truth(k))) << "spot " << k;
  }
  EXPECT_GE(verified, 2);
}

INSTANTIATE_TEST_SUITE_P(Paper, Variants,
                         testing::Values(Variant{0.03, 0.5, Icp::plane}, Variant{0.08, 0.5, Icp::plane},
                                         Variant{0.05, 1.0, Icp::point}, Variant{0.05, 0.3, Icp::plane},
                                         Variant{0.05, 0.2, Icp::plane}));

}  // namespace
}  // namespace liloc
