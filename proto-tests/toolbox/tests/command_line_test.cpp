// The program as a user runs it: exit codes, one line per error, what lands where.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "common/recording/files.hpp"
#include "common/wire/status.hpp"
#include "proto-tests/replay/tests/small_recording.hpp"
#include "proto-tests/replay/tests/temp_folder.hpp"

namespace liloc::toolbox {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

struct Outcome {
  int exit_code = -1;
  std::string out;  ///< stdout and stderr
};

Outcome liloc(const std::string& arguments) {
  Outcome outcome;
  FILE* pipe = popen((std::string(LILOC_PROGRAM) + " " + arguments + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return outcome;
  std::array<char, 4096> buffer{};
  while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe))
    outcome.out.append(buffer.data(), n);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  return outcome;
}

void expect_complaint(const Outcome& outcome, int exit_code, const std::string& part) {
  EXPECT_EQ(outcome.exit_code, exit_code) << outcome.out;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 1) << outcome.out;
  EXPECT_THAT(outcome.out, testing::StartsWith("liloc: "));
  EXPECT_THAT(outcome.out, HasSubstr(part));
}

class CommandLine : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  replay::TempFolder folder_;
};

TEST_F(CommandLine, EverySubcommandHasHelp) {
  for (const char* name : {"", "demo ", "replay ", "sim ", "align ", "doctor "}) {
    const Outcome outcome = liloc(std::string(name) + "--help");
    EXPECT_EQ(outcome.exit_code, 0) << name;
    EXPECT_THAT(outcome.out, HasSubstr("Usage"));
    EXPECT_THAT(outcome.out, Not(HasSubstr("{false}"))) << "of a flag that negates";
  }
}

TEST_F(CommandLine, BadUsageIsExitCodeTwoAndOneLine) {
  expect_complaint(liloc(""), 2, "subcommand");
  expect_complaint(liloc("dance"), 2, "dance");
  expect_complaint(liloc("replay"), 2, "REC");
  expect_complaint(liloc("sim"), 2, "OUT");
  expect_complaint(liloc("sim " + path("rec") + " --people many"), 2, "many");
  expect_complaint(liloc("sim " + path("rec") + " --lidars 99"), 2, "lidars");
  expect_complaint(liloc("sim " + path("rec") + " --seed -1"), 2, "--seed");
  expect_complaint(liloc("replay " + path("rec") + " --seed -1 --out " + path("out")), 2, "--seed");
  expect_complaint(liloc("align only-one.ply"), 2, "TARGET");
  EXPECT_FALSE(fs::exists(path("rec")));
}

TEST_F(CommandLine, DoctorTellsASilentDomainFromAHealthyServer) {
  const Outcome silent = liloc("doctor --domain 148 --seconds 0.3");
  EXPECT_EQ(silent.exit_code, 1);
  EXPECT_THAT(silent.out, HasSubstr("FAIL  no server is heard"));

  const auto seat = wire::Participant::create({.domain = 148, .role = wire::Role::server});
  ASSERT_TRUE(seat) << seat.error().message;
  const auto publisher = wire::StatusPublisher::create(*seat);
  ASSERT_TRUE(publisher) << publisher.error().message;
  wire::ServerStatus status;
  status.server_id = "edge1";
  const std::jthread server([&](const std::stop_token& stop) {
    for (; !stop.stop_requested(); std::this_thread::sleep_for(std::chrono::milliseconds(50)))
      EXPECT_TRUE(publisher->publish(status));
  });
  const Outcome heard = liloc("doctor --domain 148 --seconds 60");
  EXPECT_EQ(heard.exit_code, 0) << heard.out;
  EXPECT_THAT(heard.out, HasSubstr("ok    edge1: up for"));
}

TEST_F(CommandLine, ARecordingThatCannotBeReadIsExitCodeTwoAndLeavesNothing) {
  const std::string out = path("out");
  expect_complaint(liloc("replay " + path("nowhere") + " --lockstep --out " + out), 2, "nowhere");
  replay::write_small_recording(folder_.path() / "rec");
  ASSERT_TRUE(write_file(folder_.path() / "rec/site.json", "[1, 2"));
  expect_complaint(liloc("replay " + path("rec") + " --lockstep --out " + out), 2, "site.json");
  expect_complaint(liloc("replay " + path("rec") + " --out " + out), 2, "site.json");
  EXPECT_FALSE(fs::exists(out));
}

TEST_F(CommandLine, SimulatesAndReplays) {
  const std::string rec = path("rec"), out = path("out");
  ASSERT_EQ(
      liloc("sim " + rec + " --seed 5 --seconds 1 --image-width 80 --image-height 60 --people 0").exit_code, 0);
  const Outcome replayed = liloc("replay " + rec + " --lockstep --out " + out);
  EXPECT_EQ(replayed.exit_code, 0) << replayed.out;
  EXPECT_THAT(replayed.out, HasSubstr("device0"));
  std::ifstream report(out + "/report.json");
  const auto json = nlohmann::json::parse(report);
  EXPECT_TRUE(json["devices"]["device0"].contains("online"));
  EXPECT_TRUE(fs::exists(out + "/device0/spots.csv"));
  expect_complaint(liloc("sim " + rec), 1, "site.json");  // it does not write over a recording
}

TEST_F(CommandLine, CloudsThatCannotBeReadAreRefused) {
  expect_complaint(liloc("align " + path("a.ply") + " " + path("b.ply")), 2, "a.ply");
  ASSERT_TRUE(write_file(folder_.path() / "a.txt", "x"));
  expect_complaint(liloc("align " + path("a.txt") + " " + path("a.txt")), 2, "a.txt");
  const std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex ";
  const std::string tail = "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  ASSERT_TRUE(write_file(folder_.path() / "huge.ply", head + "4000000000" + tail + "abc"));
  expect_complaint(liloc("align " + path("huge.ply") + " " + path("huge.ply")), 2, "huge.ply");
  ASSERT_TRUE(write_file(folder_.path() / "short.ply", head + "50" + tail + "abc"));
  expect_complaint(liloc("align " + path("short.ply") + " " + path("short.ply")), 2, "short.ply");
  ASSERT_TRUE(write_file(folder_.path() / "flat.ply",
                         "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\n"
                         "property float y\nend_header\n1 2\n3 4\n"));
  expect_complaint(liloc("align " + path("flat.ply") + " " + path("flat.ply")), 2, "no z");
  ASSERT_TRUE(write_file(folder_.path() / "garbage.pcd", "FIELDS x y\nSIZE 4 4\nTYPE F F\nDATA ascii\n1 2\n"));
  expect_complaint(liloc("align " + path("garbage.pcd") + " " + path("garbage.pcd")), 2, "garbage.pcd");
}

TEST_F(CommandLine, CloudsThatAreTooThinAreNamedWithTheRemedy) {
  std::string room = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1000\nHEIGHT 1\nPOINTS 1000\nDATA ascii\n";
  for (int i = 0; i < 1000; ++i)
    room += fmt::format("{} {} {}\n", 0.1 * (i % 10), 0.1 * (i / 10 % 10), 0.1 * (i / 100));
  ASSERT_TRUE(write_file(folder_.path() / "coarse.pcd", room));
  ASSERT_TRUE(write_file(folder_.path() / "one.pcd",
                         "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\n"
                         "POINTS 1\nDATA ascii\n1 2 3\n"));
  const std::string coarse = path("coarse.pcd"), one = path("one.pcd");
  expect_complaint(liloc("align " + one + " " + coarse + " --voxel 0.2"), 1,
                   one + " into " + coarse + ": source has 0 usable points");
  expect_complaint(liloc("align " + coarse + " " + one + " --voxel 0.2"), 1,
                   coarse + " into " + one + ": target has 0 usable points");
  expect_complaint(liloc("align " + one + " " + one), 1, "a larger voxel");
}

TEST_F(CommandLine, PcdFilesThatLieAreRefusedBeforeRoomIsMadeForThem) {
  const std::string fields = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n", one = "WIDTH 1\nHEIGHT 1\nPOINTS 1\n";
  const std::uint32_t lengths[2] = {4, 2'000'000'000};
  const std::string unpacked(reinterpret_cast<const char*>(lengths), sizeof(lengths));
  for (const auto& [text, says] : std::initializer_list<std::pair<std::string, const char*>>{
           {"", "no PCD header"},
           {std::string(5000, '\x9c'), "no PCD header"},
           {"FIELDS x y z\nSIZE 4 4 4\nBAD\nDATA ascii\n", "no PCD header"},
           {fields + "DATA ascii\n", "WIDTH"},
           {"FIELDS x y q\nSIZE 4 4 4\nTYPE F F F\n" + one + "DATA ascii\n0 0 0\n", "no z"},
           {"FIELDS x y z\nSIZE 4 4\nTYPE F F F\n" + one + "DATA ascii\n0 0 0\n", "SIZEs"},
           {fields + "COUNT 1 1 100000000\n" + one + "DATA ascii\n0 0 0\n", "COUNT"},
           {fields + "WIDTH -5\nHEIGHT 1\nPOINTS -5\nDATA ascii\n0 0 0\n", "POINTS"},
           {fields + "WIDTH 1\nHEIGHT 1\nPOINTS 7\nDATA ascii\n0 0 0\n", "POINTS"},
           {fields + "WIDTH 1000\nHEIGHT 1000\nPOINTS 1000000\nDATA binary\n0 0 0\n", "claims"},
           {fields + "WIDTH 1000\nHEIGHT 1000\nDATA ascii\n0 0 0\n", "claims"},
           {fields + one + "DATA binary_compressed\n" + unpacked + "0000", "claims"}}) {
    ASSERT_TRUE(write_file(folder_.path() / "lie.pcd", text));
    const Outcome outcome = liloc("align " + path("lie.pcd") + " " + path("lie.pcd"));
    expect_complaint(outcome, 2, "lie.pcd");
    EXPECT_THAT(outcome.out, HasSubstr(says));
  }
}

TEST_F(CommandLine, AlignsPublishedPairs) {
  const fs::path pairs = "../shared/pairs/kitchen";
  if (!fs::exists(pairs / "gt.log")) GTEST_SKIP() << pairs << " is not there";
  struct Pair {
    int source, target;
    std::array<double, 3> truth;  ///< the translation, as gt.log has it
  };
  // More points of fragment 8 fit where it slides along a wall of fragment 5, into space that both saw empty.
  for (const Pair& pair :
       {Pair{1, 0, {-0.115577, -0.0387705, 0.114875}}, Pair{8, 5, {1.15805, 0.132546, -0.0848382}}}) {
    const auto fragment = [&](int i) { return (pairs / fmt::format("cloud_bin_{}.ply", i)).string(); };
    const Outcome outcome = liloc("align --json " + fragment(pair.source) + " " + fragment(pair.target));
    ASSERT_EQ(outcome.exit_code, 0) << outcome.out;
    const auto json = nlohmann::json::parse(outcome.out);
    EXPECT_TRUE(json["trusted"]) << outcome.out;
    for (std::size_t row = 0; row < 3; ++row)
      EXPECT_NEAR(json["T_target_source"][row][3], pair.truth.at(row), 0.1) << pair.source;
  }
}

}  // namespace
}  // namespace liloc::toolbox
