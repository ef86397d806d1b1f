#include "server/tools/ply_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/recording/tests/temporary_folder.hpp"
#include "server/tools/tests/cloud_texts.hpp"

namespace liloc::toolbox {
namespace {

using testing::HasSubstr;

const std::vector<Eigen::Vector3d> kPoints{{1, -2, 3}, {0.5, 0.25, -0.125}, {100, 0, 7}};

TEST(PlyFile, EveryFormatAndTypeIsRead) {
  const TemporaryFolder folder;
  const std::pair<const char*, std::string> files[] = {
      {"ascii", test::ply_of<float>(kPoints, "ascii", "float")},
      {"little", test::ply_of<double>(kPoints, "binary_little_endian", "double")},
      {"big", test::ply_of<float>(kPoints, "binary_big_endian", "float32")}};
  for (const auto& [name, text] : files) {
    const auto cloud = read_ply(folder.put(std::string(name) + ".ply", text));
    ASSERT_TRUE(cloud) << cloud.error().message;
    ASSERT_EQ(cloud->size(), kPoints.size());
    for (std::size_t i = 0; i < kPoints.size(); ++i)
      EXPECT_EQ(cloud->points[i], kPoints[i].cast<float>()) << name;
  }
}

TEST(PlyFile, PointsThatAreNotFiniteAreLeftOut) {
  const TemporaryFolder folder;
  const auto cloud = read_ply(folder.put("a.ply",
                                         "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty "
                                         "float y\nproperty float z\nend_header\n"
                                         "1 2 3\nnan 0 0\n0 inf 0\n0 0 1e999\n+4 5 6\n"));
  ASSERT_TRUE(cloud) << cloud.error().message;
  ASSERT_EQ(cloud->size(), 2U);
  EXPECT_EQ(cloud->points[1], Eigen::Vector3f(4, 5, 6));
}

TEST(PlyFile, WhatDoesNotFitIsNamedWithFileAndRemedy) {
  const std::string head = "ply\nformat ascii 1.0\n", xy = "property float x\nproperty float y\n";
  const std::pair<std::string, const char*> cases[] = {
      {head + "end_header\n", "has no element vertex"},
      {head + "element vertex 1\n" + xy + "end_header\n1 2\n", "its vertices have no z"},
      {head + "element vertex 1\n" + xy + "property list uchar float z\nend_header\n1 2 1 3\n",
       "have a list, z"},
      {head + "element vertex 1\n" + xy + "property float z\nend_header\n1 2 x\n", "no sound vertex 1 of 1"},
      {head + "element vertex 9999\n" + xy + "property float z\nend_header\n1 2 3\n",
       "claims 9999 of element vertex"},
      {head + "element face 1\nproperty list int int a\nelement vertex 1\n" + xy +
           "property float z\nend_header\n2000000000 1\n1 2 3\n",
       "ends within element face"}};
  const TemporaryFolder folder;
  for (const auto& [text, says] : cases) {
    const auto cloud = read_ply(folder.put("a.ply", text));
    ASSERT_FALSE(cloud) << says;
    EXPECT_THAT(cloud.error().message, HasSubstr(says));
    EXPECT_THAT(cloud.error().message, HasSubstr("a.ply"));
    EXPECT_THAT(cloud.error().message, HasSubstr("write it anew"));
  }
  EXPECT_FALSE(read_ply(folder.path() / "none.ply"));
}

TEST(PlyFile, EveryCutOfASoundFileIsRefused) {
  const TemporaryFolder folder;
  const std::string whole = test::ply_of<float>(kPoints, "binary_little_endian", "float");
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_FALSE(read_ply(folder.put("cut.ply", whole.substr(0, length)))) << length;
}

}  // namespace
}  // namespace liloc::toolbox
