#include "server/tools/ply_header.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace liloc::toolbox {
namespace {

using testing::HasSubstr;

TEST(PlyHeader, ElementsAndPropertiesComeInTheirOrder) {
  const std::string text =
      "ply\r\nformat binary_big_endian 1.0\r\ncomment made by hand\r\nelement vertex 7\r\n"
      "property float x\r\nproperty list uchar int32 parts\r\n\r\nelement face 0\r\nend_header\r\nDATA";
  const auto header = parse_ply_header(text);
  ASSERT_TRUE(header) << header.error().message;
  EXPECT_EQ(header->format, PlyHeader::Format::big);
  ASSERT_EQ(header->elements.size(), 2U);
  EXPECT_EQ(header->elements[0].name, "vertex");
  EXPECT_EQ(header->elements[0].count, 7U);
  ASSERT_EQ(header->elements[0].properties.size(), 2U);
  EXPECT_EQ(header->elements[0].properties[0].type, Scalar::f32);
  EXPECT_FALSE(header->elements[0].properties[0].list_length);
  EXPECT_EQ(header->elements[0].properties[1].list_length, Scalar::u8);
  EXPECT_EQ(header->elements[0].properties[1].type, Scalar::i32);
  EXPECT_TRUE(header->elements[1].properties.empty());
  EXPECT_EQ(text.substr(header->bytes), "DATA");
}

TEST(PlyHeader, WhatIsUnsoundIsNamed) {
  std::string many = "ply\nformat ascii 1.0\n";
  for (int i = 0; i < 17; ++i) many += "element e 1\n";
  std::string wide = "ply\nformat ascii 1.0\nelement vertex 1\n";
  for (int i = 0; i < 257; ++i) wide += "property float x\n";
  const std::pair<std::string, const char*> cases[] = {
      {"", "no PLY header"},
      {"plyx\nend_header\n", "no PLY header"},
      {"ply\nformat ascii 1.0\n", "no PLY header"},
      {"ply\nformat utf 1.0\nend_header\n", "its format is 'utf'"},
      {"ply\nformat\nend_header\n", "its format is ''"},
      {"ply\nelement vertex\nend_header\n", "unsound element"},
      {"ply\nelement vertex -1\nend_header\n", "claims '-1' of element vertex"},
      {"ply\nelement vertex 1e3\nend_header\n", "claims '1e3'"},
      {"ply\nelement vertex 50000001\nend_header\n", "at most 50000000"},
      {"ply\nproperty float x\nend_header\n", "unsound property"},
      {"ply\nelement vertex 1\nproperty float\nend_header\n", "unsound property"},
      {"ply\nelement vertex 1\nproperty quad x\nend_header\n", "its property x has a type 'quad'"},
      {"ply\nelement vertex 1\nproperty list quad int x\nend_header\n", "a type 'quad'"},
      {"ply\nsurprise 1\nend_header\n", "a line 'surprise'"},
      {many + "end_header\n", "unsound element"},
      {wide + "end_header\n", "unsound property"},
      {"ply\ncomment " + std::string(70'000, 'x') + "\nend_header\n", "no PLY header"}};
  for (const auto& [text, says] : cases) {
    const auto header = parse_ply_header(text);
    ASSERT_FALSE(header) << says;
    EXPECT_THAT(header.error().message, HasSubstr(says));
  }
}

}  // namespace
}  // namespace liloc::toolbox
