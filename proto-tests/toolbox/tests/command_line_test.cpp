// The program as a user runs it: exit codes, one line per error, what lands where.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "common/recording/files.hpp"
#include "common/wire/spots/status.hpp"
#include "proto-tests/replay/tests/small_recording.hpp"
#include "proto-tests/toolbox/tests/program_test.hpp"
#include "server/tools/tests/cloud_texts.hpp"

namespace liloc::toolbox {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

using CommandLine = ProgramTest;

TEST_F(CommandLine, EverySubcommandHasHelp) {
  for (const char* name : {"", "demo ", "load ", "soak ", "replay ", "sim ", "align ", "calibrate ", "convert ",
                           "doctor ", "explain ", "plan ", "record "}) {
    const Outcome outcome = liloc(std::string(name) + "--help");
    EXPECT_EQ(outcome.exit_code, 0) << name;
    EXPECT_THAT(outcome.out, HasSubstr("Usage"));
    EXPECT_THAT(outcome.out, Not(HasSubstr("{false}"))) << "of a flag that negates";
  }
}

TEST_F(CommandLine, BadUsageIsExitCodeTwoAndOneLine) {
  for (const auto& [given, says] : {std::pair{"", "a command is missing"},
                                    {"dance", "there is no command 'dance'"},
                                    {"--seed 3 --fast dance", "'--seed' needs a command before it"}}) {
    const Outcome outcome = liloc(given);
    expect_complaint(outcome, 2, says);
    EXPECT_THAT(outcome.out, HasSubstr("commands are demo, load, soak, replay, sim, align, calibrate, convert, "
                                       "doctor, explain, plan, record; see liloc --help"));
  }
  expect_complaint(liloc("align a b --one --two"), 2, "not expected: '--one' '--two'");
  expect_complaint(liloc("align a b --voxel nan"), 2, "--voxel: is 'nan'; give a number in 0.005..1");
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

TEST_F(CommandLine, DoctorFailsForALidarThatCannotBeUsedAndPrintsNothingForged) {
  const auto seat = wire::Participant::create({.domain = 149, .role = wire::Role::server});
  ASSERT_TRUE(seat) << seat.error().message;
  const auto publisher = wire::StatusPublisher::create(*seat);
  ASSERT_TRUE(publisher) << publisher.error().message;
  wire::ServerStatus status;
  status.server_id = "edge1";
  status.lidars = {
      {"blind0", wire::LidarState::blind, 6, 60, 0, "", 0.001},
      {"wide1", wire::LidarState::implausible, 6, 60, 0, "", 0.9, 24, 2.4},
      {"late2", wire::LidarState::clock_off, 6, 60, 0, "", 0.9, 2.4, 2.4, -37},
      {"ahead3", wire::LidarState::ok, 6, 60, 0, "", 0.9, 2.4, 2.4, 37, true},
      {"forged\x1b[2J\nok    all is well", wire::LidarState::malformed, 6, 0, 9, "\x1b[31mstep\n"}};
  const std::jthread server([&](const std::stop_token& stop) {
    for (; !stop.stop_requested(); std::this_thread::sleep_for(std::chrono::milliseconds(50)))
      EXPECT_TRUE(publisher->publish(status));
  });
  const Outcome heard = liloc("doctor --domain 149 --seconds 60");
  EXPECT_EQ(heard.exit_code, 1) << heard.out;
  EXPECT_THAT(heard.out, HasSubstr("FAIL  edge1: blind0 is blind, 0.1 %"));
  EXPECT_THAT(heard.out,
              HasSubstr("FAIL  edge1: wide1 measures implausible ranges, 24 m in the median, it used to be"));
  EXPECT_THAT(heard.out, HasSubstr("FAIL  edge1: late2 has another clock, 37.00 s behind the site's"));
  EXPECT_THAT(heard.out,
              HasSubstr("warn  edge1: ahead3 has a clock 37.00 s ahead of the site's, which is corrected"));
  EXPECT_THAT(heard.out, Not(HasSubstr("\x1b")));
  EXPECT_THAT(heard.out, Not(HasSubstr("\nok    all is well")));
}

TEST_F(CommandLine, ALiveSimulationThatFallsBehindLeavesImagesOutAndGoesOn) {
  const Outcome slow = liloc(
      "sim --live --domain 149 --seed 3 --seconds 4 --lidars 8 --lidar-rate 30 --image-width 640 "
      "--image-height 480 "
      "--threads 1");
  EXPECT_EQ(slow.exit_code, 0) << slow.out;
  EXPECT_THAT(slow.out, HasSubstr("behind real time"));
  EXPECT_THAT(slow.out, HasSubstr("images were left out in all"));
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

/// Three walls of 2 m in 41 x 41 points each, in ascending order of the axes.
std::vector<Eigen::Vector3d> corner_points() {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 41; ++i)
    for (int j = 0; j < 41; ++j) {
      const double a = 0.05 * i, b = 0.05 * j;
      points.insert(points.end(), {{a, b, 0}, {a, 0, b + 0.01}, {0, a + 0.01, 1.5 * b}});
    }
  return points;
}

TEST_F(CommandLine, CloudsOfEveryCoordinateTypeAreRead) {
  const std::string reference = path("reference.ply");
  ASSERT_TRUE(write_file(reference, test::ply_of<float>(corner_points(), "ascii", "float")));
  const auto aligned = [&](const std::string& file) {
    const Outcome outcome = liloc("align --json " + file + " " + reference);
    EXPECT_EQ(outcome.exit_code, 0) << file << outcome.out;
    return nlohmann::json::parse(outcome.out, nullptr, false);
  };
  const auto wanted = aligned(reference);
  EXPECT_GT(wanted["fitness"], 0.99);
  const std::pair<const char*, std::string> files[] = {
      {"a.ply", test::ply_of<double>(corner_points(), "ascii", "double")},
      {"b.ply", test::ply_of<double>(corner_points(), "binary_little_endian", "double")},
      {"c.ply", test::ply_of<double>(corner_points(), "binary_big_endian", "float64")},
      {"d.ply", test::ply_of<float>(corner_points(), "binary_little_endian", "float32")},
      {"e.ply", test::ply_of<float>(corner_points(), "binary_big_endian", "float")},
      {"a.pcd", test::pcd_of<double>(corner_points(), "ascii", 'F')},
      {"b.pcd", test::pcd_of<double>(corner_points(), "binary", 'F')},
      {"c.pcd", test::pcd_of<float>(corner_points(), "binary", 'F')}};
  for (const auto& [name, text] : files) {
    ASSERT_TRUE(write_file(folder_.path() / name, text));
    const auto got = aligned(path(name));
    for (const char* field : {"T_target_source", "fitness", "rmse_m"})
      EXPECT_EQ(got[field], wanted[field]) << name << " " << field;  // the same points: the same answer
  }
}

TEST_F(CommandLine, CloudsInTheCoordinatesOfASurveyAreAligned) {
  const Eigen::Vector3d survey(691'608.25, 5'334'765.5, 520.125);
  auto near = corner_points();
  for (Eigen::Vector3d& p : near) p -= Eigen::Vector3d(1, 1, 1);  // seen from inside
  auto far = near;
  for (Eigen::Vector3d& p : far) p += survey;
  ASSERT_TRUE(write_file(path("far.ply"), test::ply_of<double>(far, "binary_little_endian", "double")));
  ASSERT_TRUE(write_file(path("near.ply"), test::ply_of<double>(near, "ascii", "double")));
  const auto T = [&](const char* source, const char* target) {
    const Outcome outcome = liloc(fmt::format("align --gravity --json {} {}", path(source), path(target)));
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out;
    return nlohmann::json::parse(outcome.out, nullptr, false)["T_target_source"];
  };
  const auto there = T("near.ply", "far.ply"), here = T("far.ply", "far.ply");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double wanted = survey[static_cast<int>(axis)];
    EXPECT_NEAR(there[axis][3].get<double>(), wanted, 0.05) << there;
    // A turn of a microradian about a place so far off moves it by metres: where the cloud ends counts.
    const Eigen::RowVector3d row(here[axis][0], here[axis][1], here[axis][2]);
    EXPECT_NEAR(row.dot(survey) + here[axis][3].get<double>(), wanted, 0.05) << here;
  }
}

TEST_F(CommandLine, CloudsInMillimetresAreNamedAsSuch) {
  auto millimetres = corner_points();
  for (Eigen::Vector3d& p : millimetres) p *= 1000;
  ASSERT_TRUE(
      write_file(path("mm.ply"), test::ply_of<std::int16_t>(millimetres, "binary_big_endian", "short")));
  ASSERT_TRUE(write_file(path("m.ply"), test::ply_of<float>(corner_points(), "ascii", "float")));
  expect_complaint(liloc("align " + path("mm.ply") + " " + path("m.ply")), 1, "millimetres");
  expect_complaint(liloc("align " + path("m.ply") + " " + path("mm.ply")), 1, "target spans 2850 m");
}

TEST_F(CommandLine, CloudsThatCannotBeMeantAreRefusedByFieldAndType) {
  const std::string pcd = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nPOINTS 1\n";
  const std::string ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n";
  for (const auto& [name, text, says] :
       std::initializer_list<std::tuple<const char*, std::string, const char*>>{
           {"a.pcd", pcd + "DATA foo\n1 2 3\n", "its DATA is 'foo'"},
           {"b.pcd", "FIELDS x y z\nSIZE 4 8 4\nTYPE F U F\nWIDTH 1\nHEIGHT 1\nDATA ascii\n1 2 3\n",
            "its field y is TYPE U SIZE 8"},
           {"c.pcd", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F Q\nWIDTH 1\nHEIGHT 1\nDATA ascii\n1 2 3\n",
            "its field z is TYPE Q SIZE 4"},
           {"d.ply", ply + "property float z\nproperty list uchar int a\nend_header\n1 2 3 0\n",
            "have a list, a"},
           {"e.ply", ply + "property list uchar float z\nend_header\n1 2 1 3\n", "have a list, z"},
           {"f.ply", ply + "property quad z\nend_header\n1 2 3\n", "its property z has a type 'quad'"},
           {"g.ply", ply + "property float z\nend_header\n1 2 x\n", "no sound vertex 1 of 1"},
           {"h.ply", "ply\nformat utf 1.0\nend_header\n", "its format is 'utf'"},
           {"i.ply",
            "ply\nformat ascii 1.0\nelement face 1\nproperty list int int a\nelement vertex 1\n"
            "property float x\nproperty float y\nproperty float z\nend_header\n2000000000 1\n1 2 3\n",
            "ends within element face"},
           {"j.ply", "\x1b[2J", "no PLY header"}}) {
    ASSERT_TRUE(write_file(folder_.path() / name, text));
    const Outcome outcome = liloc("align " + path(name) + " " + path(name));
    expect_complaint(outcome, 2, says);
    EXPECT_THAT(outcome.out, HasSubstr(name));
  }
}

TEST_F(CommandLine, WhatOnlyHasTheNameOfAFrameIsNotWaitedFor) {
  const fs::path rec = folder_.path() / "rec";
  replay::write_small_recording(rec);
  const fs::path odd = rec / "devices/device0/depth/1700000000900000000.png";
  ASSERT_EQ(mkfifo(odd.c_str(), 0600), 0);
  const std::string replay = "replay " + rec.string() + " --lockstep --out " + path("out");
  expect_complaint(liloc(replay), 2, odd.filename().string());
  fs::remove(odd);
  fs::create_directory(odd);
  expect_complaint(liloc(replay), 2, odd.filename().string());
  fs::remove(odd);
  EXPECT_EQ(liloc(replay).exit_code, 0);
}

TEST_F(CommandLine, ARecordingWithoutASoundDeviceFrameFails) {
  const fs::path rec = folder_.path() / "rec";
  replay::write_small_recording(rec);
  for (const auto& frame : fs::directory_iterator(rec / "devices/device0/depth")) {
    fs::resize_file(frame.path(), 60);
    ASSERT_FALSE(fs::is_empty(frame.path()));
  }
  expect_complaint(liloc("replay " + rec.string() + " --lockstep --out " + path("out")), 1,
                   "none of its 2 device frames could be used; the first: ");
}

TEST_F(CommandLine, ARecordingWithoutASoundCeilingFrameFails) {
  const fs::path rec = folder_.path() / "rec";
  replay::write_small_recording(rec);
  for (const auto& frame : fs::directory_iterator(rec / "global/ceiling0/depth"))
    fs::resize_file(frame.path(), 60);
  expect_complaint(liloc("replay " + rec.string() + " --lockstep --out " + path("out")), 1,
                   "none of its 2 ceiling frames could be used; the first: ");
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
           {fmt::format("{}COUNT 1 1 100000000\n{}DATA ascii\n0 0 0\n", fields, one), "COUNT"},
           {fields + "WIDTH -5\nHEIGHT 1\nPOINTS -5\nDATA ascii\n0 0 0\n", "POINTS"},
           {fields + "WIDTH 1\nHEIGHT 1\nPOINTS 7\nDATA ascii\n0 0 0\n", "POINTS"},
           {fields + "WIDTH 1000\nHEIGHT 1000\nPOINTS 1000000\nDATA binary\n0 0 0\n", "claims"},
           {fields + "WIDTH 1000\nHEIGHT 1000\nDATA ascii\n0 0 0\n", "claims"},
           {fields + one + "DATA ascii\n\n# more\nFIELDS x y\n1 2 3\n", "FIELDS after DATA"},
           {fields + one + "DATA binary\nSIZE 6 4 4\n000000", "SIZE after DATA"},
           {fields + one + "DATA ascii", "claims"},
           {fmt::format("{}{}DATA binary_compressed\n{}0000", fields, one, unpacked), "claims"}}) {
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
