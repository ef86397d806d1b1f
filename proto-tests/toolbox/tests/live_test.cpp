// Real processes over DDS: what `liloc replay` and `liloc demo` start, they finish and end.
#include <gmock/gmock.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "proto-tests/replay/csv.hpp"
#include "proto-tests/replay/processes.hpp"
#include "proto-tests/replay/tests/temp_folder.hpp"
#include "proto-tests/sim/write_recording.hpp"

namespace liloc::toolbox {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;
using std::chrono::seconds;

#ifdef LILOC_SANITIZED
constexpr bool kMeasured = false;  // ten times slower: the processes are exercised, their answers come too late
#else
constexpr bool kMeasured = true;
#endif

/// Processes whose command line holds `text`; our own children carry the test's folder there.
std::vector<std::string> processes_with(const std::string& text) {
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::ifstream in(entry.path() / "cmdline");
    std::string line((std::istreambuf_iterator<char>(in)), {});
    std::replace(line.begin(), line.end(), '\0', ' ');
    const bool ours =
        line.find("liloc-server ") != std::string::npos || line.find("liloc-client ") != std::string::npos;
    if (ours && line.find(text) != std::string::npos) found.push_back(line);
  }
  return found;
}

class Live : public testing::Test {
 protected:
  void record(double length_s) {
    sim::SimOptions site;
    site.seed = 21;
    site.seconds = length_s;
    site.still_seconds = 1;
    site.people = 1;
    site.devices = 2;
    site.device_rate_hz = 10;
    const auto status = sim::write_recording(site, rec_);
    ASSERT_TRUE(status) << status.error().message;
  }
  Result<replay::Child> start(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), LILOC_PROGRAM);
    return replay::Child::start(arguments, log_);
  }
  static void wait(replay::Child& child, seconds limit) {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (child.running() && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }

  replay::TempFolder folder_;
  fs::path rec_ = folder_.path() / "rec", out_ = folder_.path() / "out", log_ = folder_.path() / "log";
};

TEST_F(Live, ReplayOverDdsLocatesBothDevices) {
  record(10);  // the first answers take some spots, more of them on a busy machine
  auto replay = start({"replay", rec_, "--out", out_});
  ASSERT_TRUE(replay);
  wait(*replay, seconds(60));
  ASSERT_FALSE(replay->running());
  const auto status = replay->stop();
  ASSERT_TRUE(status) << status.error().message;
  std::ifstream in(out_ / "report.json");
  const auto report = nlohmann::json::parse(in);
  EXPECT_EQ(report["mode"], "dds");
  for (const char* device : {"device0", "device1"}) {
    const auto local = replay::Csv::read(out_ / device / "local.csv");
    ASSERT_TRUE(local);
    EXPECT_GT(local->rows(), 0u);
    if (!kMeasured) continue;
    const auto& online = report["devices"][device]["online"];
    EXPECT_GT(online["coverage"], 0.5) << report.dump(1);
    EXPECT_LT(online["mean_trans_m"], 0.1) << report.dump(1);
    EXPECT_EQ(report["devices"][device]["spots"]["verified_wrong"], 0);
  }
  EXPECT_THAT(processes_with(folder_.path()), testing::IsEmpty());
}

TEST_F(Live, AStopSignalEndsAllChildren) {
  record(5);
  auto replay = start({"replay", rec_, "--out", out_});
  ASSERT_TRUE(replay);
  for (int i = 0; i < 500 && processes_with(folder_.path()).size() < 3; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(processes_with(folder_.path()).size(), 3u);  // one server, two clients
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const auto stopped = replay->stop(seconds(15));
  ASSERT_FALSE(stopped);
  EXPECT_THAT(stopped.error().message, HasSubstr("exit code 1"));
  EXPECT_THAT(stopped.error().message, HasSubstr("stopped by a signal"));
  EXPECT_THAT(processes_with(folder_.path()), testing::IsEmpty());
  EXPECT_FALSE(fs::exists(out_ / "report.json"));
}

TEST_F(Live, TheDemoLocatesItsDevices) {
  auto demo = start({"demo", "--seconds", "10"});
  ASSERT_TRUE(demo);
  wait(*demo, seconds(60));
  ASSERT_FALSE(demo->running());
  const auto status = demo->stop();
  if (kMeasured) {
    ASSERT_TRUE(status) << status.error().message;
  }
  const std::string end = replay::last_lines(log_, 3);
  EXPECT_THAT(end, HasSubstr("device0"));
  EXPECT_THAT(end, HasSubstr("device1"));
}

// Requests leave at their planned times whatever the server does, so that a server that stands still shows.
TEST_F(Live, LoadShowsAServerThatStandsStill) {
  const fs::path out = rec_.parent_path() / "load";
  auto load = start({"load", out, "--clients", "4", "--seconds", "14", "--paths", "1", "--path-seconds", "6",
                     "--freeze", "5"});
  ASSERT_TRUE(load) << load.error().message;
  wait(*load, seconds(150));
  ASSERT_FALSE(load->running());
  const auto json = nlohmann::json::parse(std::ifstream(out / "load.json"), nullptr, false);
  ASSERT_FALSE(json.is_discarded()) << replay::last_lines(log_, 5);
  EXPECT_EQ(json.at("clients"), 4);
  const auto& requests = json.at("requests");
  EXPECT_GE(requests.at("sent"), 4 * 14) << "at the latest every 800 ms, and more often while searching";
  EXPECT_EQ(requests.at("planned"), requests.at("sent"));
  EXPECT_GT(json.at("latency_ms").at("p95"), 3000);
  EXPECT_GT(json.at("server").at("cpu_s"), 0);
  EXPECT_GT(json.at("server").at("rx_mb"), json.at("server").at("tx_mb"));
  EXPECT_TRUE(fs::exists(out / "load.svg"));
  EXPECT_THAT(processes_with(out), testing::IsEmpty());
}

// Half a minute tells whether all that comes and goes does; whether memory grows takes ten.
TEST_F(Live, SoakWatchesASiteInWhichEverythingComesAndGoes) {
  const fs::path out = rec_.parent_path() / "soak";
  auto soak = start({"soak", out, "--seconds", "32", "--tape-seconds", "6", "--restart", "15", "--flap", "5",
                     "--residents", "1", "--visitors", "2", "--stay", "5"});
  ASSERT_TRUE(soak) << soak.error().message;
  wait(*soak, seconds(150));
  ASSERT_FALSE(soak->running());
  const auto json = nlohmann::json::parse(std::ifstream(out / "soak.json"), nullptr, false);
  ASSERT_FALSE(json.is_discarded()) << replay::last_lines(log_, 5);
  std::vector<std::string> names;
  for (const auto& process : json.at("processes")) {
    names.push_back(process.at("name"));
    EXPECT_GT(process.at("memory_mb").at("last"), 1) << names.back();
    EXPECT_LE(process.at("descriptors").at("growth"), 2) << names.back();
  }
  EXPECT_THAT(names, testing::ElementsAre("server", "resident0", "visitors", "sensors"));
  EXPECT_GT(json.at("answered"), 0);
  EXPECT_GE(json.at("visits"), 4);
  EXPECT_GE(json.at("lidar_flaps"), 1);
  EXPECT_EQ(json.at("restarts"), 1);
  for (const std::string why : json.at("why")) EXPECT_THAT(why, testing::Not(HasSubstr("grew"))) << "too short";
  if (kMeasured) {
    EXPECT_THAT(json.at("why"), testing::IsEmpty()) << json.at("why");
  }
  EXPECT_FALSE(json.at("judged"));
  EXPECT_THAT(replay::last_lines(log_, 2), HasSubstr("too short to judge"));
  EXPECT_TRUE(fs::exists(out / "samples.csv"));
  EXPECT_THAT(processes_with(out), testing::IsEmpty());
}

// A run that breaks off says so where the one before it had passed.
TEST_F(Live, ASoakThatBreaksOffLeavesNoOldVerdict) {
  const fs::path out = rec_.parent_path() / "soak";
  fs::create_directories(out);
  std::ofstream(out / "soak.json") << R"({"passed": true})";
  auto soak = start({"soak", out, "--seconds", "30", "--tape-seconds", "6", "--residents", "0", "--visitors",
                     "1", "--server-option=--no-such-option"});
  ASSERT_TRUE(soak) << soak.error().message;
  wait(*soak, seconds(150));
  ASSERT_FALSE(soak->running());
  EXPECT_FALSE(soak->stop()) << "exit code 1";
  const auto json = nlohmann::json::parse(std::ifstream(out / "soak.json"), nullptr, false);
  ASSERT_FALSE(json.is_discarded()) << replay::last_lines(log_, 5);
  EXPECT_EQ(json.at("passed"), false);
  EXPECT_THAT(json.at("why").at(0).get<std::string>(), HasSubstr("liloc-server"));
  EXPECT_TRUE(fs::exists(out / "samples.csv"));
  EXPECT_THAT(processes_with(out), testing::IsEmpty());
}

}  // namespace
}  // namespace liloc::toolbox
