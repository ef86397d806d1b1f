#include "server/app/site_state.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "server/localization/tests/world.hpp"

namespace liloc {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class SiteStateFile : public testing::Test {
 protected:
  SiteStateFile() : folder_(fs::temp_directory_path() / ("liloc_site_state_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~SiteStateFile() override { fs::remove_all(folder_); }
  [[nodiscard]] std::string file(const char* text = nullptr) const {
    const fs::path path = folder_ / "site.state.json";
    if (text != nullptr) std::ofstream(path) << text;
    return path.string();
  }
  fs::path folder_;
};

Site some_site(const std::string& second = "south", double second_x_m = 4) {
  Site site;
  site.global_lidars.resize(2);
  site.global_lidars[0].id = "north";
  site.global_lidars[1].id = second;
  site.global_lidars[1].T_map_sensor.translation() = Eigen::Vector3d(second_x_m, 2, 2.6);
  return site;
}

CellBounds some_bounds() {
  CellBounds bounds;
  for (int i = 0; i < 30; ++i) bounds.learn({3.0 * (i % 4), -3.0 * (i % 3), 1}, 0.3 + 0.01 * i);
  return bounds;
}

TEST_F(SiteStateFile, LiesBesideTheSite) {
  EXPECT_EQ(state_file_of("a/b/site.json"), "a/b/site.state.json");
  EXPECT_EQ(state_file_of("a/b/site.json", true), "a/b/site.standby.state.json");
}

TEST_F(SiteStateFile, WhatIsWrittenIsRead) {
  const CellBounds bounds = some_bounds();
  ASSERT_TRUE(write_site_state(file(), some_site(), 0.05, bounds));
  const auto read = read_site_state(file(), some_site(), 0.05);
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->cells().size(), bounds.cells().size());
  for (const auto& [at, cell] : bounds.cells()) {
    const auto& again = read->cells().at(at);
    EXPECT_EQ(again.count, cell.count);
    EXPECT_NEAR(again.mean, cell.mean, 1e-12);
    EXPECT_NEAR(again.variance, cell.variance, 1e-12);
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1)
      << "nothing is left over";
}

TEST_F(SiteStateFile, TheSensorsNoiseIsKeptPerLidar) {
  const std::vector<DepthNoise> noise{{0.01, 0.002, 0.6, 0.02, 12345}, {}};
  ASSERT_TRUE(write_site_state(file(), some_site(), 0.05, some_bounds(), noise));
  EXPECT_EQ(open_site_state(file(), some_site(), 0.05).noise, noise);
  ASSERT_TRUE(write_site_state(file(), some_site(), 0.05, some_bounds()));
  EXPECT_EQ(open_site_state(file(), some_site(), 0.05).noise, (std::vector<DepthNoise>(2)))
      << "a file before noise";
}

TEST_F(SiteStateFile, NoiseThatNoSensorHasIsLearnedAnew) {
  const std::string head =
      R"({"format": "liloc site state", "version": 2, "cell_m": 2.5, "voxel_size_m": 0.05, "cells": [], "lidars": )"
      R"({"south": {"x": 4, "y": 2, "z": 2.6}, "north": {"x": 0, "y": 0, "z": 0, "noise": )";
  for (const char* noise :
       {"3", "null", "{}", R"({"base_m": -1, "per_square_m": 0, "missing": 0, "flying": 0, "samples": 9})",
        R"({"base_m": 0.01, "per_square_m": 0, "missing": 7, "flying": 0, "samples": 9})"}) {
    const SiteState state = open_site_state(file((head + noise + "}}}").c_str()), some_site(), 0.05);
    EXPECT_EQ(state.noise, (std::vector<DepthNoise>(2))) << noise;
    EXPECT_EQ(state.file, file()) << "the rest of it stands: " << noise;
  }
}

TEST_F(SiteStateFile, NoFileIsNothingLearned) {
  const auto read = read_site_state(file(), some_site(), 0.05);
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->cells().empty());
}

TEST_F(SiteStateFile, HostileFilesAreErrorsThatNameThem) {
  const std::string head =
      R"({"format": "liloc site state", "version": 2, "cell_m": 2.5, "voxel_size_m": 0.05, "lidars": )"
      R"({"north": {"x": 0, "y": 0, "z": 0}, "south": {"x": 4, "y": 2, "z": 2.6}})";
  const std::string cell = R"({"x": 0, "y": 0, "count": 5, "fitness_mean": 0.5, "fitness_sd": 0.1})";
  for (const auto& [text, says] : std::initializer_list<std::pair<std::string, const char*>>{
           {"", "JSON"},
           {"[1, 2]", "object"},
           {head, "JSON"},
           {R"({"world_frame": "map"})", "no liloc site state"},
           {R"({"format": "liloc site state", "version": 1})", "version"},
           {R"({"format": "liloc site state", "version": 2, "cell_m": 2.5, "voxel_size_m": 0.05, "lidars": 2})",
            "lidars"},
           {R"({"format": "liloc site state", "version": 2, "cell_m": 2.5, "voxel_size_m": 0.05, )"
            R"("lidars": {"north": {"x": 0}, "south": {}}})",
            "lidars.north.y"},
           {head + "}", "cells"},
           {head + R"(, "cells": {}})", "cells"},
           {head + R"(, "cells": [7]})", "cells[0]"},
           {head + R"(, "cells": [{"x": 0}]})", "cells[0].y"},
           {head + R"(, "cells": [{"x": 1e99, "y": 0, "count": 5, "fitness_mean": 0.5, "fitness_sd": 0.1}]})",
            ".x"},
           {head + R"(, "cells": [{"x": 0, "y": 0, "count": 5, "fitness_mean": 7, "fitness_sd": 0.1}]})",
            "learned"},
           {head + R"(, "cells": [)" + cell + "," + cell + "]}", "twice"},
           {std::string(5 << 20, ' '), "bytes"}}) {
    const auto read = read_site_state(file(text.c_str()), some_site(), 0.05);
    ASSERT_FALSE(read) << text.substr(0, 100);
    EXPECT_THAT(read.error().message, HasSubstr(says));
    EXPECT_THAT(read.error().message, HasSubstr("site.state.json"));
  }
  ASSERT_TRUE(write_site_state(file(), some_site(), 0.03, some_bounds()));
  EXPECT_THAT(read_site_state(file(), some_site(), 0.05).error().message, HasSubstr("voxel_size_m"));
}

TEST_F(SiteStateFile, WhatAnotherSiteTaughtIsToldFromOurs) {
  ASSERT_TRUE(write_site_state(file(), some_site(), 0.05, some_bounds()));
  EXPECT_TRUE(read_site_state(file(), some_site("south", 4.2), 0.05)) << "calibrated anew";
  EXPECT_THAT(read_site_state(file(), some_site("south", 7), 0.05).error().message, HasSubstr("south"));
  EXPECT_THAT(read_site_state(file(), some_site("west"), 0.05).error().message, HasSubstr("west"));
  Site one = some_site();
  one.global_lidars.pop_back();
  EXPECT_THAT(read_site_state(file(), one, 0.05).error().message, HasSubstr("lidars"));
}

TEST_F(SiteStateFile, AServerStartsAnewAndPutsADamagedFileAside) {
  const SiteState anew = open_site_state(file("{"), some_site(), 0.05);
  EXPECT_TRUE(anew.learned.cells().empty());
  EXPECT_EQ(anew.file, file());
  EXPECT_FALSE(fs::exists(file()));
  EXPECT_TRUE(fs::exists(file() + ".unreadable"));
  ASSERT_TRUE(write_site_state(file(), some_site(), 0.05, some_bounds()));
  EXPECT_FALSE(open_site_state(file(), some_site(), 0.05).learned.cells().empty());
}

TEST_F(SiteStateFile, NothingThatWasLearnedIsEverOverwritten) {
  for (const double voxel_size_m : {0.05, 0.03, 0.08}) {  // each finds the one before, and cannot use it
    EXPECT_TRUE(open_site_state(file(), some_site(), voxel_size_m).learned.cells().empty());
    ASSERT_TRUE(write_site_state(file(), some_site(), voxel_size_m, some_bounds()));
  }
  EXPECT_TRUE(read_site_state(file() + ".unreadable", some_site(), 0.05));
  EXPECT_TRUE(read_site_state(file() + ".unreadable-2", some_site(), 0.03));
  EXPECT_TRUE(read_site_state(file(), some_site(), 0.08));
}

TEST_F(SiteStateFile, WhatCannotBePutAsideStays) {
  const SiteState in_memory = open_site_state(folder_.string(), some_site(), 0.05);
  EXPECT_TRUE(in_memory.learned.cells().empty());
  EXPECT_TRUE(in_memory.file.empty());
  EXPECT_TRUE(fs::exists(folder_));
  EXPECT_FALSE(write_site_state(folder_.string(), some_site(), 0.05, some_bounds()));
}

TEST_F(SiteStateFile, ARestartedServerKnowsWhatTheFirstLearned) {
  LocalizerOptions options;
  World first(1, options);
  for (int k = 0; k < 4; ++k) (void)first.ask(k);
  const CellBounds learned = *first.localizer->learned();
  ASSERT_FALSE(learned.cells().empty());
  ASSERT_TRUE(write_site_state(file(), first.site, options.voxel_size_m, learned));
  const World second(1, options, open_site_state(file(), first.site, options.voxel_size_m).learned);
  EXPECT_EQ(second.localizer->learned()->cells().size(), learned.cells().size());
}

}  // namespace
}  // namespace liloc
