#include "server/tools/pcd_header.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/recording/tests/temporary_folder.hpp"
#include "server/tools/tests/cloud_texts.hpp"

namespace liloc::toolbox {
namespace {

using testing::HasSubstr;

const std::vector<Eigen::Vector3d> kPoints{{1, -2, 3}, {0.5, 0.25, -0.125}};

TEST(PcdHeader, SoundOnesAreTaken) {
  const TemporaryFolder folder;
  for (const char* data : {"ascii", "binary"}) {
    EXPECT_TRUE(check_pcd_header(folder.put("a.pcd", test::pcd_of<float>(kPoints, data, 'F')))) << data;
    EXPECT_TRUE(check_pcd_header(folder.put("a.pcd", test::pcd_of<double>(kPoints, data, 'F')))) << data;
    EXPECT_TRUE(
        check_pcd_header(folder.put("a.pcd", "# a comment\n\n" + test::pcd_of<float>(kPoints, data, 'F'))));
  }
}

struct Case {
  const char* from;
  const char* to;
  const char* says;
};

TEST(PcdHeader, WhatIsUnsoundIsNamedWithFileAndRemedy) {
  const Case cases[] = {{"WIDTH", "WITDH", "no PCD header"},
                        {"FIELDS rgb x y z\n", "", "FIELDS"},
                        {"SIZE 4 4 4 4", "SIZE 4 4 4", "do not go together"},
                        {"FIELDS rgb x y z", "FIELDS rgb x y w", "have no z"},
                        {"SIZE 4 4 4 4", "SIZE 4 4 4 9", "SIZE or COUNT is out of range"},
                        {"COUNT 1 1 1 1", "COUNT 1 1 1 0", "SIZE or COUNT is out of range"},
                        {"COUNT 1 1 1 1", "COUNT 1 1 1 2", "its field z is TYPE F SIZE 4 with a COUNT"},
                        {"TYPE U F F F", "TYPE U F Q F", "its field y is TYPE Q SIZE 4"},
                        {"WIDTH 2", "WIDTH 3", "do not go together"},
                        {"WIDTH 2", "WIDTH -2", "do not go together"},
                        {"HEIGHT 1", "HEIGHT 1e9", "do not go together"},
                        {"DATA binary", "DATA foo", "its DATA is 'foo'"},
                        {"DATA binary", "DATA", "its DATA is ''"},
                        {"DATA binary\n", "DATA ascii\nPOINTS 9\n", "POINTS after DATA"},
                        {"DATA binary\n", "DATA binary_compressed\n", "which its 32 bytes"}};
  const std::string sound = test::pcd_of<float>(kPoints, "binary", 'F');
  const TemporaryFolder folder;
  for (const auto& [from, to, says] : cases) {
    std::string text = sound;
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), std::string(from).size(), to);
    const auto checked = check_pcd_header(folder.put("a.pcd", text));
    ASSERT_FALSE(checked) << says;
    EXPECT_THAT(checked.error().message, HasSubstr(says));
    EXPECT_THAT(checked.error().message, HasSubstr("a.pcd"));
  }
}

TEST(PcdHeader, EveryCutOfASoundFileIsRefused) {
  const std::string whole = test::pcd_of<float>(kPoints, "binary", 'F');
  const TemporaryFolder folder;
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_FALSE(check_pcd_header(folder.put("cut.pcd", whole.substr(0, length)))) << length;
}

TEST(PcdHeader, AHeaderThatHidesMoreBehindAZeroOrHasNoEndIsNone) {
  const TemporaryFolder folder;
  std::string hidden = test::pcd_of<float>(kPoints, "ascii", 'F');
  hidden[hidden.find("WIDTH") + 6] = '\0';
  EXPECT_FALSE(check_pcd_header(folder.put("a.pcd", hidden)));
  EXPECT_FALSE(check_pcd_header(folder.put("a.pcd", std::string(10'000, 'x'))));
  std::string endless;
  for (int i = 0; i < 100; ++i) endless += "WIDTH 2\n";
  EXPECT_FALSE(check_pcd_header(folder.put("a.pcd", endless + test::pcd_of<float>(kPoints, "ascii", 'F'))));
  EXPECT_FALSE(check_pcd_header(folder.path() / "none.pcd"));
}

}  // namespace
}  // namespace liloc::toolbox
