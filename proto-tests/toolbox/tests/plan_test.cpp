// `liloc plan` on a simulated site's scan and on drawings: what it proposes, predicts, and refuses.
#include <gmock/gmock.h>
#include <png.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/recording/files.hpp"
#include "common/recording/recording.hpp"
#include "proto-tests/toolbox/tests/program_test.hpp"

namespace liloc::toolbox {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

/// A simulated office, scanned once.
class Plan : public ProgramTest {
 protected:
  static void SetUpTestSuite() {
    site_ = std::make_unique<replay::TempFolder>();
    const Outcome made = liloc("sim " + rec() + " --seed 81 --seconds 0.5 --people 0 --width 7 --depth 6");
    ASSERT_EQ(made.exit_code, 0) << made.out;
  }
  static void TearDownTestSuite() { site_.reset(); }

  static std::string rec() { return (site_->path() / "rec").string(); }
  static std::string scan() { return "--reference " + rec() + "/reference.ply "; }
  [[nodiscard]] json told(const std::string& folder) const {
    return json::parse(std::ifstream(path(folder + "/plan.json")));
  }
  [[nodiscard]] std::string written(const std::string& name, const std::string& text) const {
    EXPECT_TRUE(write_file(path(name), text));
    return path(name);
  }
  void refuses(const std::string& arguments, const std::string& part) const {
    expect_refused("plan " + arguments + " --out " + path("out"), part, "out");
    EXPECT_FALSE(fs::exists(path(".out.part")));
  }

  inline static std::unique_ptr<replay::TempFolder> site_;
};

TEST_F(Plan, ProposesASiteThatTheServerCanUseAndEvaluatesItTheSame) {
  const Outcome planned = liloc("plan " + scan() + "--lidars 2 --out " + path("plan"));
  ASSERT_EQ(planned.exit_code, 0) << planned.out;
  EXPECT_THAT(planned.out, HasSubstr("ceiling1"));
  EXPECT_THAT(planned.out, HasSubstr("localizable"));
  const auto site = read_site(path("plan/site.json"));
  ASSERT_TRUE(site) << site.error().message;
  ASSERT_EQ(site->global_lidars.size(), 2U);
  const json plan = told("plan");
  ASSERT_EQ(plan.at("lidars").size(), 2U);
  const json translation = plan["lidars"][0].at("T_map_sensor").at("translation");
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(translation.at(static_cast<std::size_t>(axis)).get<double>(),
                site->global_lidars[0].T_map_sensor.translation()[axis], 1e-9);
  EXPECT_GT(plan.at("localizable"), 0.05);
  EXPECT_GT(plan.at("coverage"), 0.2);
  for (const char* picture : {"plan/coverage.svg", "plan/localizability.svg"}) {
    const auto svg = read_file(path(picture), 4U << 20U);
    ASSERT_TRUE(svg) << svg.error().message;
    EXPECT_THAT(*svg, HasSubstr("ceiling1"));
    EXPECT_TRUE(svg->ends_with("</svg>\n"));
  }

  const Outcome evaluated =
      liloc("plan " + scan() + "--evaluate " + path("plan/site.json") + " --out " + path("again"));
  ASSERT_EQ(evaluated.exit_code, 0) << evaluated.out;
  EXPECT_EQ(told("again"), plan);
}

TEST_F(Plan, ASeedGivesTheSamePlanAndMoreLidarsABetterOne) {
  for (const char* name : {"a", "b"})
    ASSERT_EQ(liloc("plan " + scan() + "--lidars 1 --seed 5 --out " + path(name)).exit_code, 0);
  EXPECT_EQ(told("a"), told("b"));
  ASSERT_EQ(liloc("plan " + scan() + "--lidars 3 --seed 5 --out " + path("c")).exit_code, 0);
  EXPECT_GT(told("c")["coverage"], told("a")["coverage"]);
  EXPECT_GT(told("c")["localizable"], told("a")["localizable"]);
}

TEST_F(Plan, EvaluatesTheSimulatedSiteAndStudiesIt) {
  const Outcome outcome =
      liloc("plan " + scan() + "--evaluate " + rec() + "/site.json --study --json --out " + path("out"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.out;
  const json printed = json::parse(outcome.out, nullptr, false);
  ASSERT_FALSE(printed.is_discarded()) << outcome.out;
  EXPECT_EQ(printed, told("out"));
  EXPECT_EQ(printed.at("study").at("tilts").size(), 5U);
  EXPECT_EQ(printed["study"].at("counts").size(), printed["lidars"].size());
  EXPECT_GT(printed["localizable"], 0.2);
}

TEST_F(Plan, PlansFromADrawing) {
  std::string dxf = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
  dxf +=
      "0\nLWPOLYLINE\n70\n1\n10\n0\n20\n0\n10\n8000\n20\n0\n10\n8000\n20\n3000\n10\n5000\n20\n3000\n10\n5000\n2"
      "0\n6000\n"
      "10\n0\n20\n6000\n0\nENDSEC\n0\nEOF\n";
  const std::string file = written("plan.dxf", dxf);
  ASSERT_EQ(liloc("plan --floor-plan " + file + " --height 3 --lidars 1 --out " + path("dxf")).exit_code, 0);
  EXPECT_NEAR(told("dxf")["ceiling_z_m"], 3, 0.1);
  EXPECT_NEAR(told("dxf")["free_floor_m2"], 30, 6);
}

TEST_F(Plan, BadInputIsOneLineAndLeavesNothing) {
  refuses(scan() + "--lidars 0", "--lidars: is '0'");
  refuses(scan() + "--lidars 99", "--lidars: is '99'");
  refuses(scan(), "either --lidars");
  refuses(scan() + "--lidars 2 --evaluate " + rec() + "/site.json", "either --lidars");
  refuses("--lidars 2", "either --reference");
  refuses(scan() + "--lidars 2 --scale 0.1", "--scale");
  refuses("--reference " + path("no.ply") + " --lidars 2", "no.ply");
  refuses("--reference " + written("empty.ply", "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n") +
              " --lidars 2",
          "empty.ply");
  refuses("--floor-plan " + written("plan.png", "no picture") + " --height 3 --lidars 2", "give --scale");
  refuses("--floor-plan " + path("plan.png") + " --height 3 --scale 0.02 --lidars 2", "no sound PNG");
  refuses("--floor-plan " + path("plan.png") + " --scale 0.02 --lidars 2", "give --height");
  refuses("--floor-plan " + path("plan.pdf") + " --height 3 --lidars 2", "no .png or .dxf");
  refuses(scan() + "--evaluate " + written("site.json", "{}"), "site.json");
  refuses(scan() + "--lidars 2 --device-height nan", "--device-height");
}

TEST_F(Plan, AScanInMillimetresIsNamed) {
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 8000\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n";
  for (int i = 0; i < 8000; ++i) ply += fmt::format("{} {} {}\n", 50 * (i % 100), 50 * (i / 100), 0);
  refuses("--reference " + written("mm.ply", ply) + " --lidars 2", "in metres?");
}

TEST_F(Plan, AScanInCoordinatesOfASurveyIsToldWhatToSubtract) {
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 8000\nproperty double x\nproperty double y\nproperty double "
      "z\nend_header\n";
  for (int i = 0; i < 8000; ++i)
    ply += fmt::format("{} {} 520\n", 691'608 + 0.05 * (i % 100), 5'334'765 + 0.05 * (i / 100));
  refuses("--reference " + written("far.ply", ply) + " --lidars 2", "subtract [69161");
}

// Before the scan is looked at, which is none: what would be thrown away after its work is told at once.
TEST_F(Plan, AnOutThatCannotBeMadeIsToldBeforeTheWork) {
  const std::string out = written("file", "no folder") + "/out";
  const Outcome told = liloc("plan --reference " + path("no.ply") + " --lidars 1 --out " + out);
  expect_complaint(told, 2, "--out: ");
  EXPECT_THAT(told.out, HasSubstr("cannot be made"));
}

TEST_F(Plan, AFolderThatHoldsAnythingIsLeftAlone) {
  (void)written("out/mine.txt", "mine");
  expect_complaint(liloc("plan " + scan() + "--lidars 1 --out " + path("out")), 2, "--out");
  EXPECT_TRUE(fs::exists(path("out/mine.txt")));
  EXPECT_FALSE(fs::exists(path("out/plan.json")));
}

}  // namespace
}  // namespace liloc::toolbox
