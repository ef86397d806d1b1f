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

class SiteState : public testing::Test {
 protected:
  SiteState() : folder_(fs::temp_directory_path() / ("liloc_site_state_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~SiteState() override { fs::remove_all(folder_); }
  [[nodiscard]] std::string file(const char* text = nullptr) const {
    const fs::path path = folder_ / "site.state.json";
    if (text != nullptr) std::ofstream(path) << text;
    return path.string();
  }
  fs::path folder_;
};

CellBounds some_bounds() {
  CellBounds bounds;
  for (int i = 0; i < 30; ++i) bounds.learn({3.0 * (i % 4), -3.0 * (i % 3), 1}, 0.3 + 0.01 * i);
  return bounds;
}

TEST_F(SiteState, LiesBesideTheSite) {
  EXPECT_EQ(state_file_of("a/b/site.json"), "a/b/site.state.json");
}

TEST_F(SiteState, WhatIsWrittenIsRead) {
  const CellBounds bounds = some_bounds();
  ASSERT_TRUE(write_site_state(file(), 0.05, bounds));
  const auto read = read_site_state(file(), 0.05);
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

TEST_F(SiteState, NoFileIsNothingLearned) {
  const auto read = read_site_state(file(), 0.05);
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->cells().empty());
}

TEST_F(SiteState, HostileFilesAreErrorsThatNameThem) {
  const std::string head =
      R"({"format": "liloc site state", "version": 1, "cell_m": 2.5, "voxel_size_m": 0.05)";
  const std::string cell = R"({"x": 0, "y": 0, "count": 5, "fitness_mean": 0.5, "fitness_sd": 0.1})";
  for (const auto& [text, says] : std::initializer_list<std::pair<std::string, const char*>>{
           {"", "JSON"},
           {"[1, 2]", "object"},
           {head, "JSON"},
           {R"({"world_frame": "map"})", "no liloc site state"},
           {R"({"format": "liloc site state", "version": 2})", "version"},
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
    const auto read = read_site_state(file(text.c_str()), 0.05);
    ASSERT_FALSE(read) << text.substr(0, 100);
    EXPECT_THAT(read.error().message, HasSubstr(says));
    EXPECT_THAT(read.error().message, HasSubstr("site.state.json"));
  }
  ASSERT_TRUE(write_site_state(file(), 0.03, some_bounds()));
  EXPECT_THAT(read_site_state(file(), 0.05).error().message, HasSubstr("voxel_size_m"));
}

TEST_F(SiteState, AServerStartsAnewAndPutsADamagedFileAside) {
  EXPECT_TRUE(open_site_state(file("{"), 0.05).cells().empty());
  EXPECT_FALSE(fs::exists(file()));
  EXPECT_TRUE(fs::exists(file() + ".unreadable"));
  ASSERT_TRUE(write_site_state(file(), 0.05, some_bounds()));
  EXPECT_FALSE(open_site_state(file(), 0.05).cells().empty());
  EXPECT_TRUE(open_site_state(folder_.string(), 0.05).cells().empty()) << "a folder stays where it is";
  EXPECT_TRUE(fs::exists(folder_));
  EXPECT_FALSE(write_site_state(folder_.string(), 0.05, some_bounds()));
}

TEST_F(SiteState, ARestartedServerKnowsWhatTheFirstLearned) {
  LocalizerOptions options;
  World first(1, options);
  for (int k = 0; k < 4; ++k) (void)first.ask(k);
  const CellBounds learned = *first.localizer->learned();
  ASSERT_FALSE(learned.cells().empty());
  ASSERT_TRUE(write_site_state(file(), options.voxel_size_m, learned));
  const World second(1, options, open_site_state(file(), options.voxel_size_m));
  EXPECT_EQ(second.localizer->learned()->cells().size(), learned.cells().size());
}

}  // namespace
}  // namespace liloc
