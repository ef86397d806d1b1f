// liloc-client as a process: what is wrong with its options is one line and exit code 2, before anything
// starts.
#include "common/testing/program.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace liloc {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

Outcome client(const std::string& arguments) {
  return run_program(LILOC_CLIENT, arguments);
}

void expect_refused(const Outcome& outcome, const std::string& part) {
  EXPECT_EQ(outcome.exit_code, 2) << outcome.out;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 1) << outcome.out;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr(part), Not(HasSubstr("options.")), Not(HasSubstr("\x1b"))));
}

TEST(ClientProgram, FlagsAreRefusedByTheirName) {
  for (const auto& [arguments, says] : std::initializer_list<std::pair<const char*, const char*>>{
           {"", "--id is required"},
           {"--id robot/1", "--id: is 'robot/1'; give 1 to 63 of"},
           {"--id r1 --voxel nan", "--voxel: is 'nan'; give a number in 0.01..0.5"},
           {"--id r1 --voxel 7", "--voxel: is '7'"},
           {"--id r1 --still-seconds inf", "--still-seconds"},
           {"--id r1 --depth-scale 0", "--depth-scale"},
           {"--id r1 --cpu-share nan", "--cpu-share"},
           {"--id r1 --tf-ahead-ms nan", "--tf-ahead-ms"},
           {"--id r1 --peer 'a b'", "--peer"},
           {"--id r1 --interface ''", "--interface"},
           {"--id r1 --local inertial", "--local inertial needs an IMU"},
           {"--id r1 --local magic", "--local"},
           {"--id r1 --imu-translation 0 0 0 --imu-rotation 0 0 0 9", "--imu-rotation has length 9"},
           {"--id r1 --imu-translation nan 0 0 --imu-rotation 0 0 0 1", "--imu-translation"},
           {"--id r1 --points-topic p --points-view nan 4 90 90", "--points-view"},
           {"--id r1 --imu-topic 'a b'", "--imu-topic is 'a b'"},
           {"--id r1 --map-frame /map", "--map-frame is '/map'"},
           {"--id r1 --sensor-frame 'a b'", "--sensor-frame is 'a b'"},
           {"--id r1 --odom-frame map", "--odom-frame and --map-frame are both 'map'"},
           {"--id r1 --map-frame r1/odom", "are both 'r1/odom'"},
           {"--id r1 --one --two", "not expected: '--one' '--two'"}})
    expect_refused(client(arguments), says);
}

TEST(ClientProgram, AFileIsRefusedByLineAndKey) {
  const fs::path file = fs::temp_directory_path() / ("liloc_client_" + std::to_string(getpid()) + ".toml");
  for (const auto& [text, says] : std::initializer_list<std::pair<std::string, const char*>>{
           {"idd = 'r1'", "line 1: there is no option idd; is it id?"},
           {"id = 'r1'\nvoxel = nan", "line 2: voxel: is 'nan'"},
           {"id = 'r1'\n[ros]\n", "line 2: a section"},
           {"id = 'r1'\nlocal = 'inertial'", "line 2: local inertial needs an IMU"},
           {"id = 'r1'\nodom-frame = 'map'", "line 2: odom-frame and --map-frame are both"},
           {"id = 'r1'\nmap-frame = 'r1/odom'", "line 2: --odom-frame and map-frame are both"},
           {"\xef\xbb\xbfid = 'robot/1'", "line 1: id: is 'robot/1'"},
           {"id = 'r1'\ndepth-topic = \"" + std::string(4000, 'x') + "\"", "line 2: depth-topic is 'xxx"}}) {
    std::ofstream(file, std::ios::binary) << text;
    const Outcome outcome = client("--config " + file.string());
    expect_refused(outcome, says);
    EXPECT_THAT(outcome.out, HasSubstr(file.filename().string()));
    EXPECT_LT(outcome.out.size(), 400U);
  }
  fs::remove(file);
}

}  // namespace
}  // namespace liloc
