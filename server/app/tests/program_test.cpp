// liloc-server as a process: exit codes and the ordered stop.
#include "common/testing/program.hpp"

#include <gmock/gmock.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

extern char** environ;

namespace liloc {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
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

/// The socket on which a service manager listens, and what it was told so far.
class Manager {
 public:
  Manager() : path_(fs::temp_directory_path() / ("liloc_notify_" + std::to_string(getpid()))) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path_.string().copy(address.sun_path, sizeof(address.sun_path) - 1);
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
    setenv("NOTIFY_SOCKET", path_.c_str(), 1);
    setenv("WATCHDOG_USEC", "300000", 1);
  }
  ~Manager() {
    unsetenv("NOTIFY_SOCKET");
    unsetenv("WATCHDOG_USEC");
    close(socket_);
    fs::remove(path_);
  }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;

  /// Whether it is told `word` within ten seconds.
  [[nodiscard]] bool hears(const std::string& word) {
    for (int i = 0; i < 1000; ++i, std::this_thread::sleep_for(10ms)) {
      std::array<char, 512> text{};
      const auto size = recv(socket_, text.data(), text.size(), MSG_DONTWAIT);
      if (size > 0 && std::string(text.data(), static_cast<std::size_t>(size)).find(word) != std::string::npos)
        return true;
    }
    return false;
  }

 private:
  const fs::path path_;
  const int socket_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
};

TEST(Program, TellsTheServiceManagerThatItListensLivesAndStops) {
  const fs::path site = site_file();
  Manager manager;
  const pid_t pid = spawn({"--site", site.string(), "--domain", "143"});
  EXPECT_TRUE(manager.hears("READY=1"));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(manager.hears("WATCHDOG=1"));
  kill(pid, SIGTERM);
  EXPECT_TRUE(manager.hears("STOPPING=1"));
  EXPECT_EQ(exit_code(pid), 0);
  fs::remove(site);
}

Outcome outcome_of(const std::string& arguments) {
  return run_program(LILOC_SERVER, arguments);
}

TEST(Program, AFileOfOptionsIsRefusedByLineAndKeyBeforeAnythingStarts) {
  const fs::path site = site_file();
  const fs::path config = site.string() + ".toml";
  for (const auto& [line, says] : std::initializer_list<std::pair<std::string, const char*>>{
           {"workers = 0", "line 2: workers: is '0'; give a whole number in 1..64"},
           {"worker = 1", "line 2: there is no option worker; is it workers?"},
           {"[network]\ndomain = 1", "line 2: a section"},
           {"workers 1", "line 2: is not name = value"},
           {"interface = \"aut", "line 2: a text has no closing quote; is the file whole?"},
           {"voxel = nan", "line 2: voxel: is 'nan'; give a number in 0.01..0.5"},
           {"max-rate = inf", "line 2: max-rate"},
           {"hold-ms = -1", "line 2: hold-ms"},
           {"domain = 231", "line 2: domain"},
           {"interface = \"a b\"", "line 2: interface"},
           {"server-id = \"a/b\"", "line 2: server-id: is 'a/b'"},
           {"method = \"magic\"", "line 2: method: is 'magic'"},
           {"log-level = \"" + std::string(4000, 'x') + "\"", "line 2: log-level: is 'xxx"},
           {std::string(1000, 'k') + " = 1", "line 2: there is no option kkk"},
           {"log-level = \"\x1b[2J\"", "line 2: holds a control character"}}) {
    std::ofstream(config) << "site = \"" << site.string() << "\"\n" << line;
    const Outcome outcome = outcome_of("--config " + config.string());
    EXPECT_EQ(outcome.exit_code, 2) << outcome.out;
    EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 1) << outcome.out;
    EXPECT_THAT(outcome.out, HasSubstr(says));
    EXPECT_THAT(outcome.out, HasSubstr(config.filename().string()));
    EXPECT_EQ(outcome.out.find('\x1b'), std::string::npos);
    EXPECT_LT(outcome.out.size(), 400U);
  }
  fs::remove(config);
  fs::remove(site);
}

TEST(Program, FlagsAreRefusedByTheirName) {
  for (const auto& [arguments, says] : std::initializer_list<std::pair<const char*, const char*>>{
           {"", "--site is required; see liloc-server --help"},
           {"--site s --voxel nan", "--voxel: is 'nan'"},
           {"--site s --save-answers out:wrong", "--save-answers: only liloc replay knows"},
           {"--site s --save-answers :all", "--save-answers: no folder is named"},
           {"--site s --max-rate nan", "--max-rate"},
           {"--site s --status-every nan", "--status-every"},
           {"--site s --interface ''", "--interface"},
           {"--site s --method paper --verify tracks", "--verify tracks"},
           {"--site s --metrics localhost:80", "--metrics is 'localhost:80'; give PORT"},
           {"--site s --metrics 70000", "--metrics is '70000'"},
           {"--site s --web localhost:80", "--web is 'localhost:80'; give PORT"},
           {"--site s --web 0", "--web is '0'"},
           {"--site s --web-token file", "--web-token goes with --web"},
           {"--site s --log-format xml", "--log-format"},
           {"--site s --one --two", "not expected: '--one' '--two'"}}) {
    const Outcome outcome = outcome_of(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.out;
    EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 1) << outcome.out;
    EXPECT_THAT(outcome.out, HasSubstr(says));
  }
}

TEST(Program, StartsFromAFileWithAByteOrderMark) {
  const fs::path site = site_file();
  const fs::path config = site.string() + ".toml";
  std::ofstream(config) << "\xef\xbb\xbfsite = \"" << site.string() << "\"\r\ndomain = 143\r\n";
  const pid_t pid = spawn({"--config", config.string()});
  std::this_thread::sleep_for(600ms);
  EXPECT_EQ(kill(pid, SIGTERM), 0);
  EXPECT_EQ(exit_code(pid), 0);
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
}  // namespace liloc
