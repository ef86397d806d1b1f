#include "server/tools/cloud_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

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

TEST(CloudFile, WhatLiesFarFromItsOriginIsPlacedAboutItsMiddle) {
  const TemporaryFolder folder;
  const Eigen::Vector3d survey(691'608.25, 5'334'765.5, 520.125);
  std::vector<Eigen::Vector3d> far;
  for (int i = 0; i < 100; ++i) far.push_back(survey + Eigen::Vector3d(0.1 * i, 0.05 * i, 0.02 * i));
  const auto placed =
      read_placed_cloud(folder.put("far.ply", test::ply_of<double>(far, "binary_little_endian", "double")));
  ASSERT_TRUE(placed) << placed.error().message;
  for (std::size_t i = 0; i < far.size(); ++i)
    EXPECT_LT((placed->origin + placed->cloud.points[i].cast<double>() - far[i]).norm(), 1e-5);
  const auto coarse =
      read_placed_cloud(folder.put("coarse.ply", test::ply_of<float>(far, "binary_little_endian", "float")));
  ASSERT_FALSE(coarse) << "half a metre is lost";
  EXPECT_NE(coarse.error().message.find("write x, y and z as doubles"), std::string::npos)
      << coarse.error().message;
  const auto near = read_placed_cloud(folder.put("near.pcd", test::pcd_of<double>(kPoints, "binary", 'F')));
  ASSERT_TRUE(near) << near.error().message;
  EXPECT_EQ(near->origin, Eigen::Vector3d(0, 0, 0)) << "it stays where it is";
  EXPECT_EQ(near->cloud.points[2], Eigen::Vector3f(100, 0, 7));
}

TEST(CloudFile, AScanOfTheMapLiesNearItsOriginOrSaysWhatToSubtract) {
  const TemporaryFolder folder;
  std::vector<Eigen::Vector3d> far, near;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d p(0.1 * i, 0.05 * i, 0.02 * i);
    far.push_back(Eigen::Vector3d(691'608, 5'334'765, 520) + p);
    near.push_back(Eigen::Vector3d(400, -900, 30) + p);
  }
  for (const char* type : {"double", "float"}) {
    const bool wide = std::string(type) == "double";
    const std::string text = wide ? test::ply_of<double>(far, "binary_little_endian", type)
                                  : test::ply_of<float>(far, "binary_little_endian", type);
    const auto refused = read_map_scan(folder.put("far.ply", text));
    ASSERT_FALSE(refused) << type;
    EXPECT_THAT(refused.error().message, HasSubstr("far.ply"));
    EXPECT_THAT(refused.error().message, HasSubstr("subtract [6916"));
  }
  const auto read = read_map_scan(folder.put("near.ply", test::ply_of<double>(near, "ascii", "double")));
  ASSERT_TRUE(read) << read.error().message;
  for (std::size_t i = 0; i < near.size(); ++i)
    EXPECT_LT((read->points[i].cast<double>() - near[i]).norm(), 1e-4) << "it stays where it is";
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
      {folder.put("nan.pcd", test::pcd_of<float>({Eigen::Vector3d::Constant(NAN)}, "binary", 'F')),
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
