#include "common/command/toml.hpp"

#include <gmock/gmock.h>

#include <random>

namespace liloc::command {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string error_of(const std::string& text) {
  const auto entries = parse_toml(text, "a.toml");
  return entries ? "accepted" : entries.error().message;
}

TEST(Toml, ReadsWhatOptionsNeed) {
  const auto entries = parse_toml(
      "# robot\r\nid = \"robot1\" # its name\r\n\r\ndomain=7\r\npeer = [ \"a\", 'b\\c', # two\n 'd', ]\n"
      "ros = true\n\"cpu-share\" = 5e-1\nmuch = 1_000\nnote = \"say \\\"ja\\\" \\\\ # \"",
      "a.toml");
  ASSERT_TRUE(entries) << entries.error().message;
  ASSERT_EQ(entries->size(), 7U);
  EXPECT_EQ(entries->at(0).key, "id");
  EXPECT_EQ(entries->at(0).line, 2);
  EXPECT_THAT(entries->at(0).values, ElementsAre("robot1"));
  EXPECT_THAT(entries->at(1).values, ElementsAre("7"));
  EXPECT_TRUE(entries->at(2).list);
  EXPECT_THAT(entries->at(2).values, ElementsAre("a", "b\\c", "d"));
  EXPECT_EQ(entries->at(3).line, 7);
  EXPECT_THAT(entries->at(4).values, ElementsAre("5e-1"));
  EXPECT_THAT(entries->at(5).values, ElementsAre("1000"));
  EXPECT_THAT(entries->at(6).values, ElementsAre("say \"ja\" \\ # "));
}

TEST(Toml, AByteOrderMarkIsHarmless) {
  const auto entries = parse_toml("\xef\xbb\xbfsite = \"s\"\n", "a.toml");
  ASSERT_TRUE(entries) << entries.error().message;
  EXPECT_EQ(entries->at(0).key, "site");
  EXPECT_TRUE(parse_toml("", "a.toml")->empty());
  EXPECT_TRUE(parse_toml("\xef\xbb\xbf", "a.toml")->empty());
}

TEST(Toml, WhatIsWrongIsNamedWithItsLine) {
  for (const auto& [text, says] : std::initializer_list<std::pair<std::string, const char*>>{
           {"a = 1\n[network]\nb = 2\n", "a.toml: line 2: a section"},
           {"a = 1\nvoxel 0.1\n", "line 2: is not name = value"},
           {"a = 1\n= 2\n", "line 2: is not name = value"},
           {"a = 1\ninterf", "line 2: is not name = value"},
           {"a =\n", "line 1: a has no value"},
           {"a = eth0\n", "give a number, true, false or a \"text\""},
           {"a = \"eth0\nb = 1\n", "line 1: a text has no closing quote"},
           {"a = 'x", "no closing quote"},
           {"a = [1, 2\n", "line 1: the list of a has no ]"},
           {"a = [1\nb = 2\n", "comma"},
           {"a = 1 2\n", "something follows"},
           {"a = 1\na = 2\n", "line 2: a stands in line 1 already"},
           {"a = 1\nb = \"\x1b[2J\"\n", "line 2: holds a control character"},
           {std::string("a\0= 1", 6), "line 1: holds a control character"},
           {"a = \"\\x\"\n", "escape"},
           {"a = \"" + std::string(5000, 'x') + "\"", "5000 bytes"}})
    EXPECT_THAT(error_of(text), HasSubstr(says)) << text;
}

class TomlDamage : public testing::TestWithParam<int> {};  // the parameter is the seed

TEST_P(TomlDamage, IsReadOrRefusedInOneShortLine) {
  std::mt19937 rng(static_cast<unsigned>(GetParam()));
  const std::string sound = "id = \"robot1\"\npeer = [\"a\", 'b']\ncpu-share = 0.5\nros = true # yes\n";
  for (int round = 0; round < 500; ++round) {
    std::string text = sound;
    for (unsigned flips = 1 + rng() % 6; flips > 0; --flips)
      text[rng() % text.size()] = rng() % 2 == 0 ? "\"'[]=,#\n\\ "[rng() % 10] : static_cast<char>(rng());
    text.resize(rng() % (text.size() + 1));
    const std::string error = error_of(text);
    EXPECT_LT(error.size(), 200U);
    EXPECT_EQ(error.find('\n'), std::string::npos);
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, TomlDamage, testing::Range(1, 9));

}  // namespace
}  // namespace liloc::command
