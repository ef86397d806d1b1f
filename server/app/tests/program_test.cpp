// liloc-server as a process: exit codes and the ordered stop.
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

extern char** environ;

namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

pid_t spawn(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), LILOC_SERVER);
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (auto& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  pid_t pid = -1;
  EXPECT_EQ(posix_spawn(&pid, LILOC_SERVER, nullptr, nullptr, argv.data(), environ), 0);
  return pid;
}

/// -1: it still ran after `limit` and was killed; -2: it died of a signal.
int exit_code(pid_t pid, std::chrono::milliseconds limit = 20s) {
  int status = 0;
  for (auto waited = 0ms; waited < limit; waited += 10ms, std::this_thread::sleep_for(10ms))
    if (waitpid(pid, &status, WNOHANG) == pid) return WIFEXITED(status) ? WEXITSTATUS(status) : -2;
  kill(pid, SIGKILL);
  waitpid(pid, &status, 0);
  return -1;
}

fs::path site_file() {
  fs::path file = fs::temp_directory_path() / ("liloc_program_test_" + std::to_string(getpid()) + ".json");
  std::ofstream(file)
      << R"({"world_frame": "map", "global_lidars": [{"id": "ceiling0", "width": 32, "height": 24,
    "fx": 30, "fy": 30, "cx": 16, "cy": 12, "depth_scale": 0.001, "rate_hz": 10,
    "T_map_sensor": {"translation": [0, 0, 3], "rotation_xyzw": [0, 0, 0, 1]}}]})";
  return file;
}

TEST(Program, HelpAndVersionExitWithZero) {
  EXPECT_EQ(exit_code(spawn({"--help"})), 0);
  EXPECT_EQ(exit_code(spawn({"--version"})), 0);
}

TEST(Program, BadUsageExitsWithTwo) {
  EXPECT_EQ(exit_code(spawn({})), 2);
  EXPECT_EQ(exit_code(spawn({"--site", "x.json", "--workers", "many"})), 2);
  EXPECT_EQ(exit_code(spawn({"--site", "x.json", "--queue", "0"})), 2);
  EXPECT_EQ(exit_code(spawn({"--site", "x.json", "--method", "magic"})), 2);
  EXPECT_EQ(exit_code(spawn({"--site", "x.json", "--method", "paper", "--verify", "tracks"})), 2);
  EXPECT_EQ(exit_code(spawn({"--site", "x.json", "--icp", "plain"})), 2);
  EXPECT_EQ(exit_code(spawn({"--site", "x.json", "--log-level", "loud"})), 2);
  EXPECT_EQ(exit_code(spawn({"--site", "x.json", "--domain", "999"})), 2);
  EXPECT_EQ(exit_code(spawn({"--site", "no/such/site.json"})), 2);
}

TEST(Program, StopsInOrderOnEitherSignal) {
  const fs::path site = site_file();
  for (const int signal : {SIGTERM, SIGINT}) {
    const pid_t pid = spawn({"--site", site.string(), "--domain", "143", "--status-every", "0.2"});
    std::this_thread::sleep_for(600ms);
    EXPECT_EQ(kill(pid, signal), 0);
    EXPECT_EQ(exit_code(pid), 0);
  }
  fs::remove(site);
}

TEST(Program, ReadsItsOptionsFromAFile) {
  const fs::path site = site_file();
  const fs::path config = site.string() + ".toml";
  std::ofstream(config) << "site = \"" << site.string() << "\"\nworkers = 0\n";
  EXPECT_EQ(exit_code(spawn({"--config", config.string()})), 2);
  fs::remove(config);
  fs::remove(site);
}

TEST(Program, ASecondServerInADomainOfAHostFails) {
  const fs::path site = site_file();
  const pid_t first = spawn({"--site", site.string(), "--domain", "147"});
  std::this_thread::sleep_for(600ms);
  EXPECT_EQ(exit_code(spawn({"--site", site.string(), "--domain", "147"})), 1);
  kill(first, SIGTERM);
  EXPECT_EQ(exit_code(first), 0);
  fs::remove(site);
}

TEST(Program, AStandbySitsBesideAServerOnOneHost) {
  const fs::path site = site_file();
  const std::vector<std::string> here{"--site", site.string(), "--domain", "146"};
  std::vector<std::string> beside = here;
  beside.emplace_back("--standby");
  const pid_t server = spawn(here), standby = spawn(beside);
  std::this_thread::sleep_for(600ms);
  EXPECT_EQ(exit_code(spawn(beside)), 1);  // one standby, not two
  for (const pid_t pid : {server, standby}) {
    kill(pid, SIGTERM);
    EXPECT_EQ(exit_code(pid), 0);
  }
  fs::remove(site);
}

}  // namespace
