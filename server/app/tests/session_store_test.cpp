#include "server/app/session_store.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "common/base/log.hpp"

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

Remembered some(double x_m = 3) {
  Remembered remembered;
  remembered.odom_segment = 7;
  Followed& f = remembered.followed;
  f.estimate.T_map_sensor =
      Eigen::Translation3d(x_m, 4, 1.2) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ());
  f.estimate.covariance = 1e-4 * Matrix6d::Identity();
  f.estimate.covariance(0, 5) = f.estimate.covariance(5, 0) = 2e-5;
  f.T_odom_sensor.translation() = Eigen::Vector3d(9, 8, 7);
  f.log_odds = 6.5;
  f.usual = {0.3, 1.2, 0.01, 0};
  return remembered;
}

class Store : public testing::Test {
 protected:
  Store() : folder_(fs::temp_directory_path() / ("liloc_sessions_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    log::set_sink([this](log::Level level, std::string_view) { warnings_ += level >= log::Level::warning; });
  }
  ~Store() override {
    log::set_sink({});
    fs::remove_all(folder_);
  }
  [[nodiscard]] std::string file() const { return (folder_ / "site.sessions.json").string(); }
  /// One that knows a device, written.
  void write(StampNs wall_ns = kWall) const {
    SessionStore store(file(), a_site(), wall_ns, kStart);
    EXPECT_FALSE(store.begin("robot1", 0xfedcba9876543210, kStart));
    store.note("robot1", 0xfedcba9876543210, some(), kStart);
    ASSERT_TRUE(store.save(wall_ns, kStart));
  }
  [[nodiscard]] auto read(std::uint64_t session, const Site& site = a_site(), StampNs later_ns = 0) const {
    SessionStore store(file(), site, kWall + later_ns, kStart);
    return store.begin("robot1", session, kStart + 1s);
  }

  fs::path folder_;
  int warnings_ = 0;
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
  store.note("robot1", 5, some(), kStart);
  const auto again = store.begin("robot1", 5, kStart + 3s);
  ASSERT_TRUE(again);
  EXPECT_NEAR(again->age_s, 3, 1e-9);
  EXPECT_EQ(again->remembered.odom_segment, 7U);
  EXPECT_FALSE(store.begin("robot2", 5, kStart)) << "another device";
  EXPECT_FALSE(store.begin("robot1", 5, kStart + 61s));
  store.note("robot1", 5, some(), kStart);
  EXPECT_FALSE(store.begin("robot1", 6, kStart)) << "another run";
  EXPECT_FALSE(store.begin("robot1", 5, kStart)) << "which has taken its place";
}

TEST_F(Store, WhatAnEarlierRunsRequestCameToIsNotTheNextOnes) {
  SessionStore store("", a_site(), kWall, kStart);
  EXPECT_FALSE(store.begin("robot1", 5, kStart));
  EXPECT_FALSE(store.begin("robot1", 6, kStart));
  store.note("robot1", 5, some(), kStart);
  EXPECT_FALSE(store.begin("robot1", 6, kStart));
}

TEST_F(Store, ADeviceThatIsSearchedIsNotTakenUp) {
  SessionStore store("", a_site(), kWall, kStart);
  EXPECT_FALSE(store.begin("robot1", 5, kStart));
  store.note("robot1", 5, some(), kStart);
  store.note("robot1", 5, std::nullopt, kStart);
  EXPECT_FALSE(store.begin("robot1", 5, kStart));
}

TEST_F(Store, ARestartedServerReadsWhatTheOneBeforeWrote) {
  write();
  const auto known = read(0xfedcba9876543210);
  ASSERT_TRUE(known);
  EXPECT_NEAR(known->age_s, 1, 1e-6);
  const Followed &now = known->remembered.followed, before = some().followed;
  EXPECT_TRUE(now.estimate.T_map_sensor.isApprox(before.estimate.T_map_sensor, 1e-9));
  EXPECT_TRUE(now.estimate.covariance.isApprox(before.estimate.covariance, 1e-9));
  EXPECT_TRUE(now.T_odom_sensor.isApprox(before.T_odom_sensor, 1e-9));
  EXPECT_DOUBLE_EQ(now.log_odds, before.log_odds);
  EXPECT_DOUBLE_EQ(now.usual.contradiction, before.usual.contradiction);
  EXPECT_FALSE(read(1)) << "another run of the client";
  EXPECT_EQ(warnings_, 0);
}

TEST_F(Store, WhatIsOldOrOfAnotherSiteCountsForNothing) {
  write();
  EXPECT_TRUE(read(0xfedcba9876543210, a_site(), from_seconds(58)));
  EXPECT_FALSE(read(0xfedcba9876543210, a_site(), from_seconds(61)));
  EXPECT_FALSE(read(0xfedcba9876543210, a_site(), from_seconds(-1))) << "the computer's clock was set back";
  EXPECT_FALSE(read(0xfedcba9876543210, a_site(1.001))) << "calibrated anew";
  EXPECT_EQ(warnings_, 0);
}

TEST_F(Store, ADamagedFileIsToldAndCountsForNothing) {
  write();
  std::ifstream in(file());
  const std::string good((std::istreambuf_iterator<char>(in)), {});
  const auto spoiled = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    std::ofstream(file()) << text.replace(at, from.size(), to);
    warnings_ = 0;
    EXPECT_FALSE(read(0xfedcba9876543210)) << to;
    EXPECT_EQ(warnings_, 1) << to;
  };
  spoiled(good, "");
  spoiled(good, "[]");
  spoiled("\"version\":1", "\"version\":2");
  spoiled("\"id\":\"robot1\"", "\"id\":\"../robot1\"");
  spoiled("fedcba9876543210", "-1");
  spoiled("\"log_odds\":6.5", "\"log_odds\":1e300");
  spoiled("\"covariance\":[0.0001", "\"covariance\":[-0.0001");
  spoiled("\"covariance\":[0.0001", "\"covariance\":[null");
  spoiled("\"covariance\":[0.0001,", "\"covariance\":[");
  spoiled("\"rotation_xyzw\":[", "\"rotation_xyzw\":[5,");
  spoiled("\"usual\":{", "\"usually\":{");
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
