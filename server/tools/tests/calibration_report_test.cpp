#include "server/tools/calibration_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/recording/files.hpp"
#include "common/recording/tests/temporary_folder.hpp"

namespace liloc::toolbox {
namespace {

using testing::HasSubstr;

constexpr const char* kSite =
    R"({"world_frame": "map", "owner": "hall", "global_lidars": [
    {"id": "ceiling0", "note": "by the door", "T_map_sensor": {"translation": [0, 0, 3], "rotation_xyzw": [0, 0, 0, 1]}},
    {"id": "ceiling1", "T_map_sensor": {"translation": [1, 0, 3], "rotation_xyzw": [0, 0, 0, 1]}}]})";

/// The second is not trusted.
std::vector<survey::CalibratedLidar> two_results() {
  std::vector<survey::CalibratedLidar> results(2);
  results[0].T_map_sensor.translation() = Eigen::Vector3d(0.5, -0.25, 2.75);
  results[0].moved_m = 0.25;
  results[0].evidence.residual_m = 0.004;
  results[1].moved_rad = radians(2.0);
  results[1].doubt = "it sees little of the others";
  return results;
}

std::vector<survey::LidarScan> two_scans() {
  std::vector<survey::LidarScan> scans(2);
  scans[0].lidar.id = "ceiling0";
  scans[1].lidar.id = "ceiling1";
  return scans;
}

TEST(CalibrationReport, TheTableHasARowForEachAndWhyOneIsNotTrusted) {
  testing::internal::CaptureStdout();
  print_calibration(two_scans(), two_results(), false);
  const std::string table = testing::internal::GetCapturedStdout();
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4);
  EXPECT_THAT(table, HasSubstr("ceiling0        25.0"));
  EXPECT_THAT(table, HasSubstr("no: it sees little of the others"));
}

TEST(CalibrationReport, JsonIsOneLineWithTheSameNumbers) {
  testing::internal::CaptureStdout();
  print_calibration(two_scans(), two_results(), true);
  const std::string text = testing::internal::GetCapturedStdout();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  const auto json = nlohmann::json::parse(text);
  ASSERT_EQ(json["lidars"].size(), 2U);
  EXPECT_EQ(json["lidars"][0]["id"], "ceiling0");
  EXPECT_DOUBLE_EQ(json["lidars"][0]["moved_m"], 0.25);
  EXPECT_EQ(json["lidars"][0]["trusted"], true);
  EXPECT_NEAR(json["lidars"][1]["moved_deg"], 2.0, 1e-9);
  EXPECT_EQ(json["lidars"][1]["trusted"], false);
  EXPECT_EQ(json["lidars"][1]["doubt"], "it sees little of the others");
}

TEST(CalibrationReport, TheSiteIsWrittenWithNewPlacesAndAllElseAsItWas) {
  const TemporaryFolder folder;
  const auto site = folder.put("site.json", kSite), out = folder.path() / "out.json";
  ASSERT_TRUE(write_calibrated(site, out, two_results()));
  auto written = nlohmann::ordered_json::parse(read_file(out, 1 << 20).value());
  EXPECT_EQ(written["owner"], "hall");
  EXPECT_EQ(written["global_lidars"][0]["note"], "by the door");
  EXPECT_DOUBLE_EQ(written["global_lidars"][0]["T_map_sensor"]["translation"][1], -0.25);
  EXPECT_EQ(read_file(site, 1 << 20).value(), kSite) << "the old one stays";
}

TEST(CalibrationReport, ASiteThatChangedMeanwhileOrCannotBeWrittenIsTold) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "out.json";
  for (const char* text : {"", "[]", "{}", R"({"global_lidars": []})"}) {
    const auto written = write_calibrated(folder.put("site.json", text), out, two_results());
    ASSERT_FALSE(written) << text;
    EXPECT_THAT(written.error().message, HasSubstr("changed while it was calibrated"));
    EXPECT_FALSE(std::filesystem::exists(out));
  }
  EXPECT_FALSE(write_calibrated(folder.path() / "none.json", out, two_results()));
  const auto site = folder.put("site.json", kSite);
  EXPECT_FALSE(write_calibrated(site, site / "out.json", two_results())) << "a file is no folder";
}

}  // namespace
}  // namespace liloc::toolbox
