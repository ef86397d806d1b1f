// What a wrong or hostile recording gets: one line that names file, field and remedy, and never a crash.
#include "common/recording/recording.hpp"

#include <gmock/gmock.h>
#include <png.h>

#include <random>

#include "common/recording/files.hpp"
#include "common/recording/tests/temporary_folder.hpp"
#include "common/recording/writer.hpp"

namespace liloc {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string kLidar =
    R"({"id":"c0","width":64,"height":48,"fx":45,"fy":46,"cx":31.5,"cy":23.5,"depth_scale":0.001,"rate_hz":6,)"
    R"("T_map_sensor":{"translation":[1,2,3],"rotation_xyzw":[0,0,0,1]}})";

std::string site_of(const std::string& lidars) {
  return R"({"world_frame":"map","global_lidars":[)" + lidars + "]}";
}

std::string changed(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

struct BadSite {
  const char* name;
  std::string text, expected;
};

class HostileSite : public testing::TestWithParam<BadSite> {};

TEST_P(HostileSite, IsRefusedInOneLine) {
  const TemporaryFolder folder;
  const auto site = read_site(folder.put("site.json", GetParam().text));
  ASSERT_FALSE(site);
  EXPECT_THAT(site.error().message, AllOf(HasSubstr("site.json"), HasSubstr(GetParam().expected),
                                          Not(HasSubstr("\n")), Not(HasSubstr("\x1b"))));
}

INSTANTIATE_TEST_SUITE_P(
    Sites, HostileSite,
    testing::Values(
        BadSite{"empty", "", "not valid JSON"}, BadSite{"cut", site_of(kLidar).substr(0, 90), "not valid JSON"},
        BadSite{"list", "[1,2]", "JSON object"},
        BadSite{"nesting", std::string(200'000, '['), "not valid JSON"},
        BadSite{"control", "{\"\x1b[2J", "not valid JSON"}, BadSite{"no_lidars", "{}", "global_lidars"},
        BadSite{"text_lidars", R"({"global_lidars":"all"})", "global_lidars"},
        BadSite{"number_lidar", site_of("7"), "global_lidars[0]"},
        BadSite{"twice", site_of(kLidar + "," + kLidar), "global_lidars[1].id 'c0' is used twice"},
        BadSite{"twin_topics", site_of(changed(kLidar, "c0", "c-0") + "," + changed(kLidar, "c0", "c_0")),
                "global_lidars[1].id 'c_0' is used twice"},
        BadSite{"id", site_of(changed(kLidar, "c0", "../etc")), "global_lidars[0].id"},
        BadSite{"no_fx", site_of(changed(kLidar, "\"fx\":45,", "")), "global_lidars[0].fx is missing"},
        BadSite{"zero_fx", site_of(changed(kLidar, "\"fx\":45", "\"fx\":0")), "global_lidars[0].fx is 0"},
        BadSite{"text_fx", site_of(changed(kLidar, "\"fx\":45", "\"fx\":\"45\"")), "global_lidars[0].fx"},
        BadSite{"huge_fx", site_of(changed(kLidar, "\"fx\":45", "\"fx\":1e999")), "number is out of range"},
        BadSite{"width", site_of(changed(kLidar, "64", "640000")), "global_lidars[0].width is 640000"},
        BadSite{"half_width", site_of(changed(kLidar, "64", "64.5")), "whole number"},
        BadSite{"rate", site_of(changed(kLidar, "\"rate_hz\":6", "\"rate_hz\":-6")), "rate_hz is -6"},
        BadSite{"scale", site_of(changed(kLidar, "0.001", "0")), "depth_scale"},
        BadSite{"quaternion", site_of(changed(kLidar, "0,0,0,1", "0,0,0,2")),
                "T_map_sensor.rotation_xyzw has length 2"},
        BadSite{"three", site_of(changed(kLidar, "0,0,0,1", "0,0,1")), "rotation_xyzw is [0,0,1]"},
        BadSite{"half_pixel_fx", site_of(changed(kLidar, "\"fx\":45", "\"fx\":0.5")),
                "global_lidars[0].fx is 0.5: 64 pixels would see 178 deg"},
        BadSite{"vast_fy", site_of(changed(kLidar, "\"fy\":46", "\"fy\":1e12")), "global_lidars[0].fy is 1"},
        BadSite{"metres_as_scale", site_of(changed(kLidar, "0.001", "1.0")), "depth_scale is 1"},
        BadSite{
            "over_a_kilometre",
            site_of(kLidar + "," + changed(changed(kLidar, "c0", "c1"), "1,2,3", "1021,2,3")),
            "global_lidars[1].T_map_sensor.translation: c1 hangs 1020 m from the middle one, must be at most"},
        BadSite{"sixty_kilometres",
                site_of(kLidar + "," + changed(changed(kLidar, "c0", "c1"), "1,2,3", "1,60000,3")),
                "global_lidars[1].T_map_sensor.translation"},
        BadSite{"doubled_key", site_of(changed(kLidar, "\"fx\":45", "\"fx\":45,\"fx\":46")),
                "\"fx\" stands twice in one object"},
        BadSite{"doubled_list", R"({"global_lidars":[],"global_lidars":[)" + kLidar + "]}",
                "\"global_lidars\" stands twice"},
        BadSite{"doubled_control", "{\"\x5cu001b[2J\":1,\"\x5cu001b[2J\":2}", "stands twice"},
        BadSite{"far", site_of(changed(kLidar, "1,2,3", "1,2,3e9")), "T_map_sensor.translation"},
        BadSite{"frame", changed(site_of(kLidar), "\"map\"", "\"\\n\""), "world_frame"}),
    [](const auto& bad) { return bad.param.name; });

TEST(Site, RoomsMayLieFarApart) {
  const TemporaryFolder folder;
  const std::string far = changed(changed(kLidar, "c0", "c1"), "1,2,3", "901,402,3");
  folder.put("site.json", site_of(kLidar + "," + far));
  const auto site = read_site(folder.path() / "site.json");
  ASSERT_TRUE(site) << site.error().message;
  EXPECT_EQ(site->global_lidars.size(), 2U);
}

TEST(Hostile, AbsentFilesAndFoldersAreNamed) {
  const TemporaryFolder folder;
  EXPECT_THAT(open_recording(folder.path() / "none").error().message, HasSubstr("is no folder"));
  EXPECT_THAT(open_recording(folder.path()).error().message, HasSubstr("site.json"));
  EXPECT_THAT(read_site(folder.path()).error().message, HasSubstr("not a regular file"));
  folder.put("site.json", site_of(kLidar));
  EXPECT_THAT(open_recording(folder.path()).error().message, HasSubstr("global/c0/depth"));
  folder.put("global/c0/depth/first.png", "");
  EXPECT_THAT(open_recording(folder.path()).error().message,
              AllOf(HasSubstr("first.png"), HasSubstr("rename")));
}

TEST(Hostile, DeviceMustBeNamedAsItsFolder) {
  const TemporaryFolder folder;
  folder.put("site.json", site_of(kLidar));
  folder.put("global/c0/depth/1.png", "");
  folder.put("devices/a/device.json", changed(kLidar, "c0", "b"));
  EXPECT_THAT(open_recording(folder.path()).error().message, AllOf(HasSubstr("'b'"), HasSubstr("'a'")));
  folder.put("devices/a/device.json", changed(kLidar, "c0", "a"));
  folder.put("devices/a/depth/1.png", "");
  EXPECT_TRUE(open_recording(folder.path()));
  folder.put("devices/a/imu.csv", "1,2,3");
  EXPECT_THAT(open_recording(folder.path()).error().message, AllOf(HasSubstr("imu.csv"), HasSubstr("line 1")));
}

TEST(Hostile, ImuTables) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& text) {
    const auto imu = read_imu(folder.put("imu.csv", text));
    return imu ? std::string("accepted") : imu.error().message;
  };
  EXPECT_THAT(error_of("#head\n1,0,0,0,0,0,9.8\n"), testing::Eq("accepted"));
  EXPECT_THAT(error_of("#head\r\n1,0,0,0,0,0,9.8\r\n2,0,0,0,0,0,9.8"), testing::Eq("accepted"));
  EXPECT_THAT(error_of("\xef\xbb\xbf#head\r\n1,0,0,0,0,0,9.8\r\n"), testing::Eq("accepted"));
  EXPECT_THAT(error_of("\xef\xbb\xbf"
                       "1,0,0,0,0,0,9.8\n"),
              testing::Eq("accepted"));
  EXPECT_THAT(error_of("1,0,0,0,0,0,9.8\n\xef\xbb\xbf"
                       "2,0,0,0,0,0,9.8\n"),
              HasSubstr("line 2 is not"));
  EXPECT_THAT(error_of("1,0,0,0,0,0,9.8\n1,0,0,0,0,0,9.8\n"),
              HasSubstr("line 2: timestamp_ns 1 does not rise"));
  EXPECT_THAT(error_of("1,0,0,0,0,0\n"), HasSubstr("line 1 is not"));
  EXPECT_THAT(error_of("1,0,0,0,0,0,9.8,7\n"), HasSubstr("line 1 is not"));
  EXPECT_THAT(error_of("1,0,0,0,0,0,nan\n"), HasSubstr("line 1 is not"));
  EXPECT_THAT(error_of("1.5,0,0,0,0,0,9.8\n"), HasSubstr("line 1 is not"));
  EXPECT_THAT(error_of("99999999999999999999,0,0,0,0,0,9.8\n"), HasSubstr("line 1 is not"));
}

TEST(Hostile, TumTables) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& text) {
    const auto tum = read_tum(folder.put("a.tum", text));
    return tum ? std::string("accepted") : tum.error().message;
  };
  EXPECT_THAT(error_of("1.5 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1"), testing::Eq("accepted"));
  EXPECT_THAT(error_of("1.5 0 0 0 0 0 0 1\n1.5 0 0 0 0 0 0 1"), HasSubstr("line 2: t does not rise"));
  EXPECT_THAT(error_of("1.x 0 0 0 0 0 0 1"), HasSubstr("line 1"));
  EXPECT_THAT(error_of("1 0 0 0 0 0 0 0"), HasSubstr("line 1.rotation_xyzw"));
  EXPECT_THAT(error_of("99999999999999 0 0 0 0 0 0 1"), HasSubstr("line 1"));
}

std::string eight_bit_png(int color_type) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = 64;
  image.height = 48;
  image.format = color_type == PNG_COLOR_TYPE_RGB ? PNG_FORMAT_RGB : PNG_FORMAT_GRAY;
  const std::vector<std::uint8_t> pixels(64 * 48 * 3, 90);
  std::string bytes(1 << 20, '\0');
  png_alloc_size_t size = bytes.size();
  EXPECT_TRUE(png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, nullptr));
  bytes.resize(size);
  return bytes;
}

const Camera kCamera{64, 48, 45, 46, 31.5, 23.5, 0.001};

TEST(HostileDepth, WrongKindAndSizeAreSaid) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& bytes, const Camera& camera) {
    const auto image = read_depth({1, folder.put("1.png", bytes)}, camera);
    return image ? std::string("accepted") : image.error().message;
  };
  EXPECT_THAT(error_of(eight_bit_png(PNG_COLOR_TYPE_GRAY), kCamera), HasSubstr("8 bits"));
  EXPECT_THAT(error_of(eight_bit_png(PNG_COLOR_TYPE_RGB), kCamera), HasSubstr("3 channel(s)"));
  EXPECT_THAT(error_of("", kCamera), HasSubstr("no sound PNG"));
  EXPECT_THAT(error_of("not a png at all", kCamera), HasSubstr("no sound PNG"));
  ASSERT_TRUE(write_depth(folder.path(), {1, 32, 48, std::vector<std::uint16_t>(32 * 48, 7)}));
  const auto image = read_depth({1, folder.path() / "1.png"}, kCamera);
  ASSERT_FALSE(image);
  EXPECT_THAT(image.error().message, AllOf(HasSubstr("32x48"), HasSubstr("64x48")));
}

class CorruptPng : public testing::TestWithParam<int> {};  // the parameter is the seed

TEST_P(CorruptPng, NeverCrashes) {
  const TemporaryFolder folder;
  std::mt19937 rng(static_cast<unsigned>(GetParam()));
  DepthImage image{5, 64, 48, {}};
  for (int i = 0; i < 64 * 48; ++i)
    image.units.push_back(static_cast<std::uint16_t>(2000 + i % 64 + rng() % 5));
  ASSERT_TRUE(write_depth(folder.path(), image));
  const std::string sound = *read_file(folder.path() / "5.png", 1 << 20);
  int refused = 0;
  for (int round = 0; round < 60; ++round) {
    std::string bytes = sound;
    if (round % 3 == 0)
      bytes.resize(rng() % bytes.size());
    else
      for (unsigned flips = 1 + rng() % 8; flips > 0; --flips)
        bytes[rng() % bytes.size()] = static_cast<char>(rng());
    const auto read = read_depth({5, folder.put("5.png", bytes)}, kCamera);
    if (!read) {
      ++refused;
      EXPECT_THAT(read.error().message, HasSubstr("5.png"));
    } else {
      EXPECT_EQ(read->units.size(), image.units.size());
    }
  }
  EXPECT_GT(refused, 50) << "checksums must catch nearly all damage";
}
INSTANTIATE_TEST_SUITE_P(Seeds, CorruptPng, testing::Range(1, 6));

}  // namespace
}  // namespace liloc
