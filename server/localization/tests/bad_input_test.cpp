// Clouds that no room gave, rooms that look alike from two places, and devices that no ceiling sees.
#include <gmock/gmock.h>

#include <random>

#include "server/localization/spot_solver.hpp"
#include "server/localization/tests/world.hpp"

namespace liloc {
namespace {

Cloud grid(int columns, int rows, float step) {
  Cloud cloud;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) cloud.points.emplace_back(step * i - 2, step * j - 1, 3.0F);
  return cloud;
}

SpotReply asked_with(const Cloud& cloud) {
  World world(1);
  SpotReply reply;
  for (int k = 0; k < 4; ++k) {  // as often as a walk needs to be verified
    world.watch(k);
    SpotRequest request = world.request(k, world.truth(k));
    request.lpc = encode(cloud, {.codec = CloudCodec::draco}).value();
    reply = world.localizer->locate(request);
    EXPECT_FALSE(reply.verified()) << "spot " << k << " " << reply.text;
  }
  return reply;
}

TEST(BadInput, AnEmptyCloudOrNoBytesAreRefused) {
  World world(1);
  world.watch(0);
  SpotRequest request = world.request(0, world.truth(0));
  request.lpc.bytes.clear();
  EXPECT_EQ(world.localizer->locate(request).reason, Reason::bad_cloud);
  EXPECT_FALSE(encode({})) << "a client cannot send one";
}

TEST(BadInput, OnePointIsRefused) {
  EXPECT_EQ(asked_with({{{0, 0, 1}}, {}}).reason, Reason::bad_cloud);
}

TEST(BadInput, TheSamePointOverAndOverIsRefused) {
  Cloud same;
  same.points.assign(50'000, {0.3F, -0.2F, 2});
  EXPECT_EQ(asked_with(same).reason, Reason::bad_cloud);
}

TEST(BadInput, APlaneIsNeverVerified) {
  EXPECT_NE(asked_with(grid(80, 40, 0.05F)).status, SpotStatus::verified);
}

TEST(BadInput, NoiseIsNeverVerified) {
  std::mt19937 rng(11);
  std::uniform_real_distribution<float> unit(-3, 3);
  Cloud noise;
  for (int i = 0; i < 100'000; ++i) noise.points.emplace_back(unit(rng), unit(rng), unit(rng));
  EXPECT_NE(asked_with(noise).status, SpotStatus::verified);
}

TEST(BadInput, PointsThatAreNotNumbersNeverReachTheSearch) {
  World world(1);
  world.watch(0);
  Cloud cloud = grid(80, 40, 0.05F);
  cloud.points[7].x() = NAN;
  EXPECT_FALSE(encode(cloud));
  const Query query = make_query(cloud, nullptr, {});
  for (const auto& p : query.cloud.points) EXPECT_TRUE(p.allFinite());
}

TEST(BadInput, AMillionPointsAreThinnedAndStillFound) {
  World world(1);
  world.watch(0);
  const auto snapshot = world.cloud->nearest(kT0);
  ASSERT_TRUE(snapshot);
  const Pose T = world.truth(0);
  const Camera camera = scene::small_camera();
  const Cloud seen = *depth_to_cloud(scene::render(world.room, T, camera, kT0, 0.005, 1), camera);
  std::mt19937 rng(3);
  std::normal_distribution<float> noise(0, 0.004F);
  Cloud million;
  while (million.size() < 1'000'000)
    for (const auto& p : seen.points)
      million.points.emplace_back(p + Eigen::Vector3f(noise(rng), noise(rng), noise(rng)));
  const Query query = make_query(million, &camera, {});
  EXPECT_LT(query.cloud.size(), 20'000U);
  const Target target = (*snapshot)->target();
  SpotProblem problem{target, query, T.linear().transpose() * Eigen::Vector3d::UnitZ()};
  const auto found = judge_candidates(problem, GravityProposer().propose(problem));
  ASSERT_FALSE(found.empty());
  EXPECT_TRUE(near(found.front().T_map_sensor(), T));
}

class ThinnedToFewBytes : public testing::TestWithParam<unsigned> {};

TEST_P(ThinnedToFewBytes, IsStillFound) {
  World world(GetParam());
  for (int k = 0; k < 4; ++k) {
    world.watch(k);
    SpotRequest request = world.request(k, world.truth(k));
    const Cloud thin = voxel_downsample(decode(request.lpc).value(), world.voxel_size_m, 900);
    ASSERT_GT(thin.size(), 450U);
    request.lpc = encode(thin).value();
    const SpotReply reply = world.localizer->locate(request);
    ASSERT_TRUE(reply.T_map_sensor) << "spot " << k << " " << reply.text;
    EXPECT_TRUE(near(*reply.T_map_sensor, world.truth(k))) << "spot " << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ThinnedToFewBytes, testing::Range(1U, 6U));

class OneCamera : public testing::TestWithParam<unsigned> {};

TEST_P(OneCamera, IsEnoughToAnswerAndNeverToBeWrong) {
  World world(GetParam(), {}, {}, 1);
  int answered = 0;
  for (int k = 0; k < 6; ++k) {
    const SpotReply reply = world.ask(k);
    answered += reply.T_map_sensor.has_value();
    EXPECT_TRUE(!reply.verified() || near(*reply.T_map_sensor, world.truth(k))) << "spot " << k;
  }
  EXPECT_EQ(answered, 6);
}

INSTANTIATE_TEST_SUITE_P(Seeds, OneCamera, testing::Range(1U, 6U));

class SymmetricRoom : public testing::TestWithParam<unsigned> {};

TEST_P(SymmetricRoom, IsNeverVerifiedWrong) {
  World world(GetParam());
  world.room.furniture.clear();  // half a turn about its middle and it looks the same
  for (int k = 0; k < 6; ++k) {
    const SpotReply reply = world.ask(k);
    EXPECT_TRUE(!reply.verified() || near(*reply.T_map_sensor, world.truth(k)))
        << "spot " << k << " " << name_of(reply.reason) << " " << reply.text;
    SpotRequest cold = world.request(k, world.truth(k));
    cold.cold = true;
    const SpotReply alone = world.localizer->locate(cold);
    EXPECT_TRUE(!alone.verified() || near(*alone.T_map_sensor, world.truth(k)))
        << "cold spot " << k << " margin " << alone.margin << " " << alone.text;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, SymmetricRoom, testing::Range(1U, 9U));

TEST(BadInput, DamagedSurroundingsAreLeftOutAndSaid) {
  World world(1);
  for (int k = 0; k < 4; ++k) {
    world.watch(k);
    SpotRequest request = world.request(k, world.truth(k));
    request.extra = request.lpc;
    request.extra.bytes.resize(request.extra.bytes.size() / 2);
    const SpotReply reply = world.localizer->locate(request);
    ASSERT_TRUE(reply.T_map_sensor) << "the frame itself is sound";
    EXPECT_TRUE(near(*reply.T_map_sensor, world.truth(k)));
    EXPECT_THAT(reply.text, testing::HasSubstr("surroundings"));
  }
}

TEST(BadInput, ADeviceOutsideTheCoveredAreaIsNeverVerified) {
  World world(2);
  scene::BoxRoom other = scene::furnished_room(77);  // a larger room, which no ceiling LiDAR sees
  other.walls.high = {9.5, 7.0, 3.4};
  std::swap(other, world.room);
  const scene::BoxRoom& seen = other;
  for (int k = 0; k < 6; ++k) {
    for (std::size_t i = 0; i < world.site.global_lidars.size(); ++i)
      ASSERT_TRUE(world.cloud->add_depth(i, scene::render(seen, world.site.global_lidars[i].T_map_sensor,
                                                          scene::small_camera(), kT0 + k * kStep, 0.005, 5)));
    const SpotReply reply = world.localizer->locate(world.request(k, world.truth(k)));
    EXPECT_FALSE(reply.verified()) << "spot " << k << " " << name_of(reply.reason) << " overlap "
                                   << reply.overlap << " fitness " << reply.fitness << " margin "
                                   << reply.margin;
  }
}

}  // namespace
}  // namespace liloc
