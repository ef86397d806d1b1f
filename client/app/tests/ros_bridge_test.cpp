#include "client/app/ros_bridge.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

using Level = wire::Diagnosis::Level;

Level level(client::State state, const std::string& problem = "", bool silent = false) {
  client::PoseUpdate newest;
  newest.state = state;
  newest.server_connected = true;
  client::Stats stats;
  stats.problem = problem;
  return diagnosis_of("robot1", newest, stats, silent).level;
}

TEST(Diagnosis, LevelFollowsTheState) {
  EXPECT_EQ(level(client::State::tracking), Level::ok);
  EXPECT_EQ(level(client::State::searching), Level::warn);
  EXPECT_EQ(level(client::State::coasting), Level::warn);
  EXPECT_EQ(level(client::State::lost), Level::error);
  EXPECT_EQ(level(client::State::tracking, "the IMU is in g"), Level::warn);
  EXPECT_EQ(level(client::State::tracking, "", true), Level::stale);
}

TEST(Diagnosis, NamesTheProblemAndTheFigures) {
  client::PoseUpdate newest;
  client::Stats stats;
  stats.frames = 42;
  stats.problem = "the IMU is in g";
  const auto diagnosis = diagnosis_of("robot1", newest, stats, false);
  EXPECT_NE(diagnosis.message.find("no server"), std::string::npos);
  EXPECT_NE(diagnosis.message.find("the IMU is in g"), std::string::npos);
  bool found = false;
  for (const auto& [key, value] : diagnosis.values) found = found || (key == "frames" && value == "42");
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace liloc
