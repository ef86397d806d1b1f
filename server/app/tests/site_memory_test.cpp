#include "server/app/site_memory.hpp"

#include <gtest/gtest.h>

#include "common/base/log.hpp"
#include "common/recording/tests/temporary_folder.hpp"

namespace liloc {
namespace {

constexpr double kVoxel = 0.05;

Site one_lidar() {
  Site site;
  site.global_lidars.resize(1);
  site.global_lidars[0].id = "north";
  return site;
}

std::shared_ptr<const CellBounds> some_bounds() {
  CellBounds bounds;
  for (int i = 0; i < 30; ++i) bounds.learn({1, 2, 1}, 0.3 + 0.01 * i);
  return std::make_shared<CellBounds>(std::move(bounds));
}

DepthNoise noise(double base_m) {
  DepthNoise noise;
  noise.base_m = base_m;
  noise.samples = 1000;
  return noise;
}

class Memory : public testing::Test {
 protected:
  [[nodiscard]] std::string file() const { return folder_.path() / "site.state.json"; }
  /// Whether `save` wrote.
  [[nodiscard]] bool writes(SiteMemory& memory, const std::shared_ptr<const CellBounds>& learned,
                            const DepthNoise& of_north) const {
    std::filesystem::remove(file());
    memory.save(learned, {of_north});
    return std::filesystem::exists(file());
  }
  const TemporaryFolder folder_;
  const Site site_ = one_lidar();
};

TEST_F(Memory, TheNextRunStartsWithWhatThisOneLearned) {
  {
    SiteMemory memory(file(), site_, kVoxel);
    EXPECT_TRUE(memory.at_start().learned.cells().empty());
    memory.save(some_bounds(), {noise(0.01)});
  }
  const SiteMemory next(file(), site_, kVoxel);
  EXPECT_EQ(next.at_start().learned.cells().size(), some_bounds()->cells().size());
  ASSERT_EQ(next.at_start().noise.size(), 1U);
  EXPECT_NEAR(next.at_start().noise[0].base_m, 0.01, 1e-9);
}

TEST_F(Memory, NothingNewIsNotWritten) {
  SiteMemory memory(file(), site_, kVoxel);
  const auto bounds = some_bounds();
  EXPECT_TRUE(writes(memory, bounds, noise(0.01)));
  EXPECT_FALSE(writes(memory, bounds, noise(0.01)));
  EXPECT_FALSE(writes(memory, bounds, noise(0.0103))) << "within a tenth";
  EXPECT_TRUE(writes(memory, bounds, noise(0.02)));
  EXPECT_TRUE(writes(memory, some_bounds(), noise(0.02)));
  memory.begin(bounds);
  EXPECT_FALSE(writes(memory, bounds, noise(0.02)));
}

TEST_F(Memory, WithoutAFileNothingIsKeptAndTroubleWithItIsTold) {
  SiteMemory none("", site_, kVoxel);
  none.save(some_bounds(), {noise(0.01)});
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
  int told = 0;
  log::set_sink([&](log::Level, std::string_view line) {
    told += line.find("name another with --state") != std::string_view::npos ? 1 : 0;
  });
  SiteMemory memory(file(), site_, kVoxel);
  std::filesystem::create_directories(std::filesystem::path(file()) / "in-its-place");
  memory.save(some_bounds(), {noise(0.01)});
  log::set_sink({});
  EXPECT_EQ(told, 1);
}

}  // namespace
}  // namespace liloc
