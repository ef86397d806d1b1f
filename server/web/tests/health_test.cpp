#include "server/web/health.hpp"

#include <gtest/gtest.h>

namespace liloc::web {
namespace {

ServerFacts with(wire::LidarState state) {
  ServerFacts facts;
  facts.lidars.push_back({{"ceiling0", wire::LidarState::silent, 0, 0, 0, ""}, std::nullopt});
  facts.lidars.push_back({{"ceiling1", state, 8, 9, 0, ""}, 0.1});
  return facts;
}

TEST(Health, OneLidarThatIsHeardMakesItReady) {
  for (const auto state : {wire::LidarState::ok, wire::LidarState::slow}) {
    EXPECT_EQ(ready_page(with(state)).status, 200);
    EXPECT_EQ(ready_page(with(state)).body, "1 of 2 ceiling LiDARs are heard\n");
  }
}

TEST(Health, WithoutAnyItLivesButIsNotReady) {
  for (const auto state : {wire::LidarState::waiting, wire::LidarState::silent, wire::LidarState::malformed}) {
    EXPECT_EQ(live_page(with(state)).status, 200);
    EXPECT_EQ(ready_page(with(state)).status, 503);
    EXPECT_EQ(ready_page(with(state)).body, "none of 2 ceiling LiDARs is heard\n");
  }
}

TEST(Health, AHungNetworkIsNeitherLiveNorReady) {
  ServerFacts facts = with(wire::LidarState::ok);
  facts.network_idle_s = 7;
  EXPECT_EQ(live_page(facts).status, 503);
  EXPECT_EQ(ready_page(facts).status, 503);
  EXPECT_NE(ready_page(facts).body.find("hung for 7 s"), std::string::npos);
}

TEST(Health, AHungWorkerIsNeitherLiveNorReady) {
  ServerFacts facts = with(wire::LidarState::ok);
  facts.service.longest_work_s = 3;  // a search that is cut off
  EXPECT_EQ(live_page(facts).status, 200);
  facts.service.longest_work_s = 12;
  EXPECT_EQ(live_page(facts).status, 503);
  EXPECT_EQ(ready_page(facts).status, 503);
  EXPECT_NE(live_page(facts).body.find("worker has hung for 12 s"), std::string::npos);
}

}  // namespace
}  // namespace liloc::web
