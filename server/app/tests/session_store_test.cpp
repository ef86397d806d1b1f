#include "server/app/session_store.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "common/base/log.hpp"
#include "server/app/tests/remembered_device.hpp"

namespace liloc {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr SessionStore::Time kStart{1000s};
constexpr StampNs kWall = 1'800'000'000'000'000'000;

Site a_site(double x_m = 1) {
  Site site;
  site.global_lidars.resize(1);
  site.global_lidars[0].id = "north";
  site.global_lidars[0].T_map_sensor.translation().x() = x_m;
  return site;
}

class Store : public testing::Test {
 protected:
  Store() : folder_(fs::temp_directory_path() / ("liloc_sessions_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    log::set_sink([this](log::Level level, std::string_view line) {
      if (level >= log::Level::warning) lines_.emplace_back(line);
    });
  }
  ~Store() override {
    log::set_sink({});
    fs::remove_all(folder_);
  }
  [[nodiscard]] std::string file() const { return (folder_ / "site.sessions.json").string(); }
  /// One that knows two devices, written.
  void write(StampNs wall_ns = kWall) const {
    fs::remove(file());
    SessionStore store(file(), a_site(), wall_ns, kStart);
    EXPECT_FALSE(store.begin("robot1", 0xfedcba9876543210, kStart));
    store.note("robot1", 0xfedcba9876543210, test::remembered_device(), kStart);
    EXPECT_FALSE(store.begin("robot2", 0xabcdef, kStart));
    store.note("robot2", 0xabcdef, test::remembered_device(5), kStart);
    ASSERT_TRUE(store.save(wall_ns, kStart));
  }
  [[nodiscard]] auto read(std::uint64_t session, const Site& site = a_site(), StampNs later_ns = 0) const {
    SessionStore store(file(), site, kWall + later_ns, kStart);
    return store.begin("robot1", session, kStart + 1s);
  }

  fs::path folder_;
  std::vector<std::string> lines_;  ///< warnings
};

TEST_F(Store, LiesBesideTheState) {
  EXPECT_EQ(sessions_file_of("a/site.state.json"), "a/site.sessions.json");
  EXPECT_EQ(sessions_file_of("a/learned"), "a/learned.sessions.json");
  EXPECT_EQ(sessions_file_of(""), "");
}

TEST_F(Store, TheSameRunOfAClientGetsWhatIsRememberedForAMinute) {
  SessionStore store("", a_site(), kWall, kStart);
  EXPECT_FALSE(store.begin("robot1", 5, kStart));
  EXPECT_FALSE(store.begin("robot1", 5, kStart)) << "nothing was noted";
  store.note("robot1", 5, test::remembered_device(), kStart);
  const auto again = store.begin("robot1", 5, kStart + 3s);
  ASSERT_TRUE(again);
  EXPECT_NEAR(again->age_s, 3, 1e-9);
  EXPECT_EQ(again->remembered.odom_segment, 7U);
  EXPECT_FALSE(store.begin("robot2", 5, kStart)) << "another device";
  EXPECT_FALSE(store.begin("robot1", 5, kStart + 61s));
  store.note("robot1", 5, test::remembered_device(), kStart);
  EXPECT_FALSE(store.begin("robot1", 6, kStart)) << "another run";
  EXPECT_FALSE(store.begin("robot1", 5, kStart)) << "which has taken its place";
}

TEST_F(Store, WhatAnEarlierRunsRequestCameToIsNotTheNextOnes) {
  SessionStore store("", a_site(), kWall, kStart);
  EXPECT_FALSE(store.begin("robot1", 5, kStart));
  EXPECT_FALSE(store.begin("robot1", 6, kStart));
  store.note("robot1", 5, test::remembered_device(), kStart);
  EXPECT_FALSE(store.begin("robot1", 6, kStart));
}

TEST_F(Store, ADeviceThatIsSearchedIsNotTakenUp) {
  SessionStore store("", a_site(), kWall, kStart);
  EXPECT_FALSE(store.begin("robot1", 5, kStart));
  store.note("robot1", 5, test::remembered_device(), kStart);
  store.note("robot1", 5, std::nullopt, kStart);
  EXPECT_FALSE(store.begin("robot1", 5, kStart));
}

TEST_F(Store, ARestartedServerReadsWhatTheOneBeforeWrote) {
  write();
  const auto known = read(0xfedcba9876543210);
  ASSERT_TRUE(known);
  EXPECT_NEAR(known->age_s, 1, 1e-6);
  const Followed &now = known->remembered.followed, before = test::remembered_device().followed;
  EXPECT_TRUE(now.estimate.T_map_sensor.isApprox(before.estimate.T_map_sensor, 1e-9));
  EXPECT_TRUE(now.estimate.covariance.isApprox(before.estimate.covariance, 1e-9));
  EXPECT_TRUE(now.T_odom_sensor.isApprox(before.T_odom_sensor, 1e-9));
  EXPECT_DOUBLE_EQ(now.log_odds, before.log_odds);
  EXPECT_DOUBLE_EQ(now.usual.contradiction, before.usual.contradiction);
  EXPECT_FALSE(read(1)) << "another run of the client";
  EXPECT_THAT(lines_, testing::IsEmpty());
}

TEST_F(Store, WhatIsOldOrOfAnotherSiteCountsForNothing) {
  write();
  EXPECT_TRUE(read(0xfedcba9876543210, a_site(), from_seconds(58)));
  EXPECT_FALSE(read(0xfedcba9876543210, a_site(), from_seconds(61)));
  EXPECT_FALSE(read(0xfedcba9876543210, a_site(), from_seconds(-1))) << "the computer's clock was set back";
  EXPECT_FALSE(read(0xfedcba9876543210, a_site(1.001))) << "calibrated anew";
  EXPECT_FALSE(read(0xfedcba9876543210, a_site(std::nextafter(1, 2)))) << "the same, to the last bit";
  EXPECT_THAT(lines_, testing::IsEmpty());
}

/// What `write` wrote, with a part of it replaced.
class SpoiledStore : public Store {
 protected:
  void spoil(const std::string& from, const std::string& to) {
    write();
    std::ifstream in(file());
    std::string text((std::istreambuf_iterator<char>(in)), {});
    const auto at = from.empty() ? 0 : text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    std::ofstream(file()) << (from.empty() ? to : text.replace(at, from.size(), to));
    lines_.clear();
  }
};

TEST_F(SpoiledStore, AFileThatIsNoneIsToldAndCountsForNothing) {
  for (const auto& [from, to] :
       {std::pair{"", ""}, std::pair{"", "[]"}, std::pair{"\"version\":1", "\"version\":2"},
        std::pair{"\"saved_s\":", "\"saved\":"}, std::pair{"\"clients\":[", "\"customers\":["}}) {
    spoil(from, to);
    EXPECT_FALSE(read(0xfedcba9876543210)) << to;
    EXPECT_EQ(lines_.size(), 1U) << to;
  }
}

TEST_F(SpoiledStore, AClientThatCannotBeUsedCostsItselfAlone) {
  for (const auto& [from, to, says] :
       {std::tuple{"\"id\":\"robot1\"", "\"id\":\"../robot1\"", "clients[0].id"},
        std::tuple{"fedcba9876543210", "-1", "clients[0].session"},
        std::tuple{"\"age_s\":", "\"age\":", "clients[0].age_s"},
        std::tuple{"\"log_odds\":6.5", "\"log_odds\":1e300", "clients[0].log_odds"},
        std::tuple{"[{\"id\"", "[7,{\"id\"", "clients[0] is no object"}}) {
    spoil(from, to);
    EXPECT_EQ(read(0xfedcba9876543210).has_value(), std::string_view(to).starts_with("[7")) << to;
    ASSERT_EQ(lines_.size(), 1U) << to;
    EXPECT_THAT(lines_[0], testing::AllOf(testing::HasSubstr("devices are searched anew; the first: "),
                                          testing::HasSubstr(says)));
    SessionStore store(file(), a_site(), kWall, kStart);
    EXPECT_TRUE(store.begin("robot2", 0xabcdef, kStart)) << "it is as it was: " << to;
  }
}

TEST_F(Store, ADeviceThatComesBackNeedsNoRoom) {
  SessionStore store("", a_site(), kWall, kStart);
  for (int i = 0; i < 4096; ++i) {
    const std::string id = "robot" + std::to_string(i);
    EXPECT_FALSE(store.begin(id, 5, kStart + i * 1ms));
    store.note(id, 5, test::remembered_device(), kStart + i * 1ms);
  }
  EXPECT_TRUE(store.begin("robot0", 5, kStart + 10s)) << "the oldest of a full house";
  EXPECT_FALSE(store.begin("a-stranger", 5, kStart + 10s));
  EXPECT_FALSE(store.begin("robot0", 5, kStart + 10s)) << "it has made room";
  EXPECT_TRUE(store.begin("robot2", 5, kStart + 10s));
}

TEST_F(Store, WhatCouldNotBeWrittenIsTriedAgainAndOthersCannotReadIt) {
  const fs::path in_its_place = fs::path(file()) / "x";
  SessionStore store(file(), a_site(), kWall, kStart);
  fs::create_directories(in_its_place);
  EXPECT_FALSE(store.begin("robot1", 5, kStart));
  EXPECT_FALSE(store.save(kWall, kStart));
  fs::remove_all(file());
  ASSERT_TRUE(store.save(kWall, kStart));
  ASSERT_TRUE(fs::exists(file()));
  EXPECT_EQ(fs::status(file()).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(Store, AFileIsWrittenWhereSomethingHasChangedAndTroubleIsTold) {
  SessionStore store(file(), a_site(), kWall, kStart);
  ASSERT_TRUE(store.save(kWall, kStart));
  EXPECT_FALSE(fs::exists(file()));
  EXPECT_FALSE(store.begin("robot1", 5, kStart));
  ASSERT_TRUE(store.save(kWall, kStart));
  EXPECT_TRUE(fs::exists(file()));
  std::ofstream(folder_ / "no-folder") << "";
  SessionStore nowhere((folder_ / "no-folder" / "x").string(), a_site(), kWall, kStart);
  EXPECT_FALSE(nowhere.begin("robot1", 5, kStart));
  EXPECT_FALSE(nowhere.save(kWall, kStart));
}

}  // namespace
}  // namespace liloc
