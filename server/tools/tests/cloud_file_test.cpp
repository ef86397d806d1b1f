#include "server/tools/cloud_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/recording/tests/temporary_folder.hpp"
#include "server/tools/tests/cloud_texts.hpp"

namespace liloc::toolbox {
namespace {

using testing::HasSubstr;

const std::vector<Eigen::Vector3d> kPoints{{1, -2, 3}, {0.5, 0.25, -0.125}, {100, 0, 7}};

TEST(CloudFile, BothKindsAreReadByTheirEnding) {
  const TemporaryFolder folder;
  const std::pair<const char*, std::string> files[] = {
      {"a.ply", test::ply_of<float>(kPoints, "binary_little_endian", "float")},
      {"A.PLY", test::ply_of<double>(kPoints, "ascii", "double")},
      {"a.pcd", test::pcd_of<float>(kPoints, "ascii", 'F')},
      {"b.pcd", test::pcd_of<float>(kPoints, "binary", 'F')},
      {"c.pcd", test::pcd_of<double>(kPoints, "binary", 'F')}};
  for (const auto& [name, text] : files) {
    const auto cloud = read_cloud_file(folder.put(name, text));
    ASSERT_TRUE(cloud) << cloud.error().message;
    ASSERT_EQ(cloud->size(), kPoints.size()) << name;
    for (std::size_t i = 0; i < kPoints.size(); ++i)
      EXPECT_EQ(cloud->points[i], kPoints[i].cast<float>()) << name;
    EXPECT_FALSE(cloud->has_normals());
  }
}

TEST(CloudFile, IntegersArePointsToo) {
  const TemporaryFolder folder;
  const std::vector<Eigen::Vector3d> whole{{1, -2, 3}, {40, 50, 60}};
  for (const char* data : {"ascii", "binary"}) {
    const auto cloud = read_cloud_file(folder.put("a.pcd", test::pcd_of<std::int32_t>(whole, data, 'I')));
    ASSERT_TRUE(cloud) << cloud.error().message;
    EXPECT_EQ(cloud->points[1], Eigen::Vector3f(40, 50, 60)) << data;
  }
}

TEST(CloudFile, WhatIsNoCloudIsRefusedByFileWithTheRemedy) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "folder.ply");
  const std::pair<std::filesystem::path, const char*> cases[] = {
      {folder.path() / "none.ply", "no readable file; check the path"},
      {folder.path() / "folder.ply", "no readable file"},
      {folder.put("a.txt", "x"), "neither .ply nor .pcd"},
      {folder.put("noending", "x"), "neither .ply nor .pcd"},
      {folder.put("garbage.ply", "x"), "no PLY header"},
      {folder.put("garbage.pcd", "x"), "no PCD header"},
      {folder.put("nan.pcd",
                  "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nDATA ascii\nnan nan nan\n"),
       "no finite point"},
      {folder.put("empty.ply",
                  "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
                  "property float z\nend_header\n"),
       "no finite point"}};
  for (const auto& [file, says] : cases) {
    const auto cloud = read_cloud_file(file);
    ASSERT_FALSE(cloud) << file;
    EXPECT_THAT(cloud.error().message, HasSubstr(says));
    EXPECT_THAT(cloud.error().message, HasSubstr(file.filename().string()));
  }
}

}  // namespace
}  // namespace liloc::toolbox
