#include "proto-tests/load/script.hpp"

#include <gmock/gmock.h>

namespace liloc::load {
namespace {

TEST(LoadScript, ToAndFroTurnsAtBothEnds) {
  EXPECT_EQ(to_and_fro(3, 10), 3);
  EXPECT_EQ(to_and_fro(13, 10), 7);
  EXPECT_EQ(to_and_fro(20, 10), 0);
  EXPECT_EQ(to_and_fro(24, 10), 4);
  EXPECT_EQ(to_and_fro(5, 0), 0);
}

TEST(LoadScript, EachFrameThatTellsEnoughHasARequestAndTheTruth) {
  LoadOptions options;
  options.paths = 1;
  options.path_s = 4;
  options.codec = "voxel";
  double done = 0;
  const auto script = make_script(options, [&](double share) { done = share; });
  ASSERT_TRUE(script) << script.error().message;
  EXPECT_GT(done, 0.9);
  EXPECT_EQ(script->site.global_lidars.size(), 3U);
  EXPECT_GT(script->ceiling.size(), 60U);
  EXPECT_TRUE(std::ranges::is_sorted(script->ceiling, {}, &CeilingFrame::at_s));
  ASSERT_EQ(script->paths.size(), 1U);
  const Path& path = script->paths.front();
  ASSERT_GT(path.size(), 30U);
  std::size_t requests = 0;
  const Pose T_map_odom = path.front().T_map_sensor * path.front().T_odom_sensor.inverse();
  for (const ScriptFrame& frame : path) {
    EXPECT_LT(distance_m(T_map_odom * frame.T_odom_sensor, frame.T_map_sensor), 0.1);
    if (!frame.request) continue;
    ++requests;
    EXPECT_FALSE(frame.request->lpc.bytes.empty());
    EXPECT_EQ(frame.request->lpc.codec, CloudCodec::voxel);
  }
  EXPECT_GT(requests, path.size() * 9 / 10);
}

TEST(LoadOptions, CloudsTravelByACodecThatThereIs) {
  LoadOptions options;
  EXPECT_TRUE(options.validated());
  options.codec = "zip";
  EXPECT_THAT(options.validated().error().message, testing::HasSubstr("--codec is 'zip'"));
}

}  // namespace
}  // namespace liloc::load
