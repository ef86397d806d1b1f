// `liloc calibrate` on simulated sites, from places that are off: what it finds, and what it does not trust.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/recording/recording.hpp"
#include "common/recording/tests/temporary_folder.hpp"
#include "common/testing/program.hpp"

namespace liloc {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

Outcome liloc(const std::string& arguments) {
  return run_program(LILOC_PROGRAM, arguments);
}

/// Two simulated sites, made once; the first one's LiDARs stand 5 cm and 3 degrees off in `off.json`.
class Calibrate : public testing::Test {
 public:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    for (const char* seed : {"711", "712"})
      ASSERT_EQ(liloc("sim " + path(seed) + " --seed " + seed + " --seconds 3").exit_code, 0);
    nlohmann::json site = nlohmann::json::parse(std::ifstream(path("711/site.json")));
    for (auto& lidar : site["global_lidars"]) {
      lidar["note"] = "by the door";
      auto& T = lidar["T_map_sensor"];
      T["translation"][0] = T["translation"][0].get<double>() + 0.05;
      const auto q = T["rotation_xyzw"];
      const Eigen::Quaterniond turned =
          Eigen::Quaterniond(q[3].get<double>(), q[0].get<double>(), q[1].get<double>(), q[2].get<double>()) *
          Eigen::Quaterniond(Eigen::AngleAxisd(radians(3), Eigen::Vector3d(1, 2, 2).normalized()));
      T["rotation_xyzw"] = {turned.x(), turned.y(), turned.z(), turned.w()};
    }
    std::ofstream(path("off.json")) << site;
  }
  static void TearDownTestSuite() { folder_.reset(); }

 protected:
  static std::string path(const std::string& name) { return (folder_->path() / name).string(); }
  static Outcome calibrate(const std::string& rest) {
    return liloc("calibrate " + path("711") + " --site " + path("off.json") + " --frames 15 " + rest);
  }
  static void expect_true_places(const std::string& found_file) {
    const auto found = read_site(path(found_file)), truth = read_site(path("711/site.json"));
    ASSERT_TRUE(found && truth);
    for (std::size_t i = 0; i < truth->global_lidars.size(); ++i) {
      const Pose &T = found->global_lidars[i].T_map_sensor, &T_true = truth->global_lidars[i].T_map_sensor;
      EXPECT_LT(distance_m(T, T_true), 0.005) << i;
      EXPECT_LT(degrees(angle_between_rad(T, T_true)), 0.1) << i;
    }
  }

  inline static std::unique_ptr<TemporaryFolder> folder_;
};

TEST_F(Calibrate, FindsPlacesFromARoughGuessAndKeepsTheRestOfTheFile) {
  const Outcome outcome = calibrate("--reference " + path("711/reference.ply") + " --out " + path("near.json"));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  expect_true_places("near.json");
  const auto site = nlohmann::json::parse(std::ifstream(path("near.json")));
  for (const auto& lidar : site["global_lidars"]) EXPECT_EQ(lidar["note"], "by the door");
}

TEST_F(Calibrate, FindsPlacesWithoutAGuess) {
  const Outcome outcome =
      calibrate("--initial none --reference " + path("711/reference.ply") + " --out " + path("none.json"));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
  expect_true_places("none.json");
}

TEST_F(Calibrate, TrustsNothingInAnotherRoomAndWritesNothing) {
  const Outcome outcome =
      calibrate("--reference " + path("712/reference.ply") + " --out " + path("wrong.json"));
  EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("no"));
  EXPECT_FALSE(fs::exists(path("wrong.json")));
}

TEST_F(Calibrate, RefusesRoughStartsThatAreNone) {
  for (const char* start : {"nowhere 1 2 3 4", "ceiling0 nan 2 3 4", "ceiling0 1 1e30 3 4"}) {
    const Outcome outcome = calibrate("--near " + std::string(start) + " --out " + path("x.json"));
    EXPECT_EQ(outcome.exit_code, 2) << outcome.out;
    EXPECT_THAT(outcome.out, HasSubstr("--near"));
  }
}

TEST_F(Calibrate, WithoutAScanTrustsTheOthersNoMoreThanTheFirst) {
  const Outcome outcome = calibrate("--json --out " + path("alone.json"));
  const auto told = nlohmann::json::parse(outcome.out.substr(outcome.out.find('{')), nullptr, false);
  ASSERT_FALSE(told.is_discarded()) << outcome.out;
  const auto& lidars = told.at("lidars");
  EXPECT_LT(lidars.at(0).at("moved_m").get<double>(), 1e-9);
  const bool first = lidars.at(0).at("doubt") == "";
  for (const auto& lidar : lidars) EXPECT_TRUE(first || lidar.at("doubt") != "") << lidar;
}

TEST_F(Calibrate, RefusesAScanInCoordinatesOfASurvey) {
  std::ofstream(path("far.ply"))
      << "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double "
         "z\nend_header\n691608 5334765 520\n691609 5334765 520\n691608 5334766 521\n";
  const Outcome outcome = calibrate("--reference " + path("far.ply") + " --out " + path("x.json"));
  EXPECT_EQ(outcome.exit_code, 2) << outcome.out;
  EXPECT_THAT(outcome.out, HasSubstr("far.ply"));
  EXPECT_THAT(outcome.out, HasSubstr("subtract [69160"));
  EXPECT_FALSE(fs::exists(path("x.json")));
}

TEST_F(Calibrate, NamesTheFileThatIsWrong) {
  const Outcome outcome = calibrate("--reference " + path("no.ply") + " --out " + path("x.json"));
  EXPECT_NE(outcome.exit_code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("no.ply"));
  EXPECT_FALSE(fs::exists(path("x.json")));
}

}  // namespace
}  // namespace liloc
