#include "server/tools/plan/dxf_file.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "common/recording/files.hpp"
#include "common/recording/tests/temporary_folder.hpp"

namespace liloc::toolbox {
namespace {

using testing::HasSubstr;

std::string entities(const std::string& body, const std::string& header = "9\n$INSUNITS\n70\n6\n") {
  return "0\nSECTION\n2\nHEADER\n9\n$EXTMIN\n10\n1e+20\n20\n1e+20\n" + header +
         "0\nENDSEC\n0\nSECTION\n2\nTABLES\n0\nLAYER\n70\nx\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" + body +
         "0\nENDSEC\n0\nEOF\n";
}

std::string line(double x0, double y0, double x1, double y1) {
  return fmt::format("0\nLINE\n8\nwalls\n10\n{}\n20\n{}\n11\n{}\n21\n{}\n", x0, y0, x1, y1);
}

const std::string kRectangle =
    "0\nLWPOLYLINE\n90\n4\n70\n1\n10\n0\n20\n0\n10\n6\n20\n0\n10\n6\n20\n4\n10\n0\n20\n4\n";

class DxfFile : public testing::Test {
 protected:
  [[nodiscard]] Result<plan::Outline> read(const std::string& text, std::optional<double> scale = {}) const {
    const auto file = folder_.path() / "plan.dxf";
    EXPECT_TRUE(write_file(file, text));
    return read_dxf(file, scale);
  }
  void expect_fails(const std::string& text, const std::string& part) const {
    const auto outline = read(text);
    ASSERT_FALSE(outline) << part;
    EXPECT_THAT(outline.error().message, HasSubstr("plan.dxf"));
    EXPECT_THAT(outline.error().message, HasSubstr(part));
  }
  /// Floor that the walls enclose.
  static double inside_m2(const Result<plan::Outline>& outline) {
    const auto cloud = plan::extruded(outline.value(), 3).value();
    const auto level = std::ranges::count_if(cloud.points, [](const auto& p) { return p.z() > 2.99F; });
    return 0.05 * 0.05 * static_cast<double>(level);
  }
  TemporaryFolder folder_;
};

TEST_F(DxfFile, ReadsEveryKindOfWall) {
  const std::string lines = line(0, 0, 6, 0) + line(6, 0, 6, 4) + line(6, 4, 0, 4) + line(0, 4, 0, 0);
  const std::string old =
      "0\nPOLYLINE\n66\n1\n70\n1\n0\nVERTEX\n10\n0\n20\n0\n0\nVERTEX\n10\n6\n20\n0\n0\nVERTEX\n10\n6\n20\n4\n"
      "0\nVERTEX\n10\n0\n20\n4\n0\nSEQEND\n";
  for (const std::string& body : {lines, kRectangle, old})
    EXPECT_NEAR(inside_m2(read(entities(body))), 24, 1.5);
  const std::string circle = "0\nCIRCLE\n10\n3\n20\n3\n40\n2\n";
  EXPECT_NEAR(inside_m2(read(entities(circle))), 12.6, 1.5);
  const std::string halves =
      "0\nARC\n10\n3\n20\n3\n40\n2\n50\n90\n51\n270\n0\nARC\n10\n3\n20\n3\n40\n2\n50\n270\n51\n90\n";
  EXPECT_NEAR(inside_m2(read(entities(halves))), 12.6, 1.5);
  const std::string bulged = "0\nLWPOLYLINE\n70\n1\n10\n1\n20\n3\n42\n1\n10\n5\n20\n3\n42\n1\n";
  EXPECT_NEAR(inside_m2(read(
                  entities("0\nLWPOLYLINE\n70\n0\n10\n1\n20\n3\n42\n1\n10\n5\n20\n3\n42\n1\n10\n1\n20\n3\n"))),
              12.6, 1.5);
  EXPECT_TRUE(read(entities(kRectangle + bulged)));
}

TEST_F(DxfFile, TakesTheUnitFromTheFileOrTheScaleFromTheCaller) {
  const std::string millimetres =
      line(0, 0, 6000, 0) + line(6000, 0, 6000, 4000) + line(6000, 4000, 0, 4000) + line(0, 4000, 0, 0);
  EXPECT_NEAR(inside_m2(read(entities(millimetres, "9\n$INSUNITS\n70\n4\n"))), 24, 1.5);
  EXPECT_NEAR(inside_m2(read(entities(millimetres, ""), 0.001)), 24, 1.5);
  EXPECT_NEAR(inside_m2(read(entities(kRectangle, "9\n$INSUNITS\n70\n4\n"), 1.0)), 24, 1.5);
  expect_fails(entities(millimetres, ""), "give --scale");
  expect_fails(entities(millimetres), "correct --scale");
}

TEST_F(DxfFile, ReadsLinesThatEndInCarriageReturns) {
  std::string text = entities(kRectangle), returned;
  for (const char c : text) returned += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_TRUE(read(returned));
}

TEST_F(DxfFile, WhatIsNoSoundFileIsNamedByItsLine) {
  expect_fails("hello\nworld\n", "line 1 is 'hello'");
  expect_fails("AutoCAD Binary DXF\r\n\x1a", "binary DXF");
  expect_fails("", "no EOF");
  expect_fails(entities(kRectangle).substr(0, 200), "save it anew");
  expect_fails(entities("0\nLINE\n10\nabc\n"), "is 'abc'");
  expect_fails(entities("0\nLINE\n10\nnan\n"), "is 'nan'");
  expect_fails(entities("0\nLINE\n10\n1e300\n"), "is '1e300'");
  expect_fails(entities("0\nTEXT\n10\n1\n20\n1\n"), "draws no wall");
}

TEST_F(DxfFile, TooManyWallsAreRefused) {
  std::string many;
  for (int i = 0; i < 100'100; ++i) many += "0\nLINE\n10\n0\n11\n5\n";
  expect_fails(entities(many), "over 100000 walls");
}

// Each leg is 63 chords, and no entity follows that would end the polyline.
TEST_F(DxfFile, TooManyChordsAreRefusedWhereverTheyAreDrawn) {
  std::string legs;
  for (int i = 0; i < 2'000; ++i) legs += fmt::format("10\n{}\n20\n0\n42\n1e9\n", i % 7);
  expect_fails(entities("0\nLWPOLYLINE\n70\n0\n" + legs), "over 100000 walls");
  std::string vertices;
  for (int i = 0; i < 2'000; ++i) vertices += fmt::format("0\nVERTEX\n10\n{}\n20\n0\n42\n1e9\n", i % 7);
  const std::string cut = "0\nSECTION\n2\nENTITIES\n0\nPOLYLINE\n70\n0\n" + vertices + "0\nEOF\n";
  expect_fails(cut, "over 100000 walls");
}

TEST_F(DxfFile, SheetsInPaperSpaceAreNoWalls) {
  const std::string frame =
      "0\nLWPOLYLINE\n67\n1\n70\n1\n10\n-100\n20\n-100\n10\n741\n20\n-100\n10\n741\n20\n494\n"
      "0\nPOLYLINE\n67\n1\n70\n1\n0\nVERTEX\n10\n-90\n20\n-90\n0\nVERTEX\n10\n700\n20\n400\n"
      "0\nSEQEND\n";
  EXPECT_NEAR(inside_m2(read(entities(frame + kRectangle))), 24, 1.5);
  expect_fails(entities(frame), "draws no wall");
}

TEST_F(DxfFile, AnArcOfNoSenseIsNoWall) {
  expect_fails(entities("0\nARC\n10\n3\n20\n3\n40\n0\n50\n0\n51\n0\n"), "spans 0 m");
}

}  // namespace
}  // namespace liloc::toolbox
