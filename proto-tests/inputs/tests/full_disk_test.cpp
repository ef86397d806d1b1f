// A daemon whose trace fills its disk.
#include <unistd.h>

#include "common/recording/files.hpp"
#include "proto-tests/inputs/tests/live_site.hpp"

namespace liloc::inputs {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

/// Each row has as many columns as the first.
void expect_whole_rows(const std::filesystem::path& file) {
  const std::string text = read_file(file, 1 << 20).value_or("");
  EXPECT_THAT(text, EndsWith("\n")) << file;
  std::istringstream in(text);
  std::ptrdiff_t columns = -1;
  std::string line;
  std::getline(in, line);  // names of the columns
  while (std::getline(in, line)) {
    const auto here = std::ranges::count_if(line, [](char c) { return c == ',' || c == ' '; });
    if (columns < 0) columns = here;
    EXPECT_EQ(here, columns) << file << ": " << line;
  }
}

TEST_F(LiveSite, ATraceOnAFullDiskIsToldAtOnceAndStaysWhole) {
  const std::string own = geteuid() == 0 ? "-m" : "-rm";
  const auto disk = folder_.path() / "disk", left = folder_.path() / "left";
  std::filesystem::create_directories(disk);
  const std::string mount = fmt::format("mount -t tmpfs -o size=28k tmpfs {}", disk.string());
  if (run_program("unshare", fmt::format("{} sh -c '{}'", own, mount)).exit_code != 0)
    GTEST_SKIP() << "no file system of our own is permitted";
  open(small_site(2, 1));
  if (HasFatalFailure()) return;
  std::string client = LILOC_CLIENT;
  for (const std::string& argument : device(0)) client += " " + argument;
  const Outcome told = run_program(
      "unshare", fmt::format("{} sh -c '{} && {{ timeout -s INT 5 {} --trace {}; cp -a {} {}; }}'", own, mount,
                             client, (disk / "trace").string(), (disk / "trace").string(), left.string()));
  const std::string full = "No space left on device";
  const auto first = told.out.find(full), stopping = told.out.find("stopping");
  ASSERT_NE(first, std::string::npos) << told.out;
  EXPECT_LT(first, stopping) << "not only when the client stops: " << told.out;
  EXPECT_THAT(told.out, HasSubstr("/disk/trace/"));
  for (const auto& entry : std::filesystem::directory_iterator(left)) expect_whole_rows(entry.path());
  EXPECT_GT(std::filesystem::file_size(left / "local.csv"), 1000U);
}

}  // namespace
}  // namespace liloc::inputs
