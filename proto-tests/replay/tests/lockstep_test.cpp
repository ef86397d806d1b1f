// The whole way, from a simulated recording to located devices, in one process.
#include <gmock/gmock.h>

#include <fstream>

#include "common/recording/files.hpp"
#include "common/recording/writer.hpp"
#include "proto-tests/replay/csv.hpp"
#include "proto-tests/replay/prepare.hpp"
#include "proto-tests/replay/replay.hpp"
#include "proto-tests/replay/tests/temp_folder.hpp"
#include "proto-tests/sim/write_recording.hpp"
#include "server/answers/explanation.hpp"

namespace liloc::replay {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kSiteSeed = 11;

/// A small office, five seconds, one carried device: simulated once for all tests.
class Lockstep : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TempFolder>();
    sim::SimOptions site;
    site.seed = kSiteSeed;
    site.seconds = 5;
    site.still_seconds = 1;
    site.people = 1;
    site.device_rate_hz = 10;
    const auto status = sim::write_recording(site, folder_->path() / "rec");
    ASSERT_TRUE(status) << status.error().message;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static ReplayOptions options(const std::string& out) {
    ReplayOptions options;
    options.recording = folder_->path() / "rec";
    options.out = folder_->path() / out;
    options.lockstep = true;
    return options;
  }

  static std::string text_of(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  /// A trace without its measured times, which no two runs share.
  static std::string without_latency(const fs::path& file) {
    const auto csv = Csv::read(file);
    if (!csv) return "unreadable";
    std::ifstream in(file);
    std::string header, text;
    std::getline(in, header);
    for (std::size_t row = 0; row < csv->rows(); ++row)
      for (const std::string& column : split_cells(header))
        if (column != "latency_ms") text += std::string(csv->text(row, column)) + ",";
    return text;
  }

  static std::unique_ptr<TempFolder> folder_;
};
std::unique_ptr<TempFolder> Lockstep::folder_;

TEST_F(Lockstep, LocatesTheDevice) {
  const auto report = replay(options("located"));
  ASSERT_TRUE(report) << report.error().error.message;
  ASSERT_EQ(report->devices.size(), 1u);
  const DeviceScore& device = report->devices[0];
  EXPECT_TRUE(device.has_truth);
  EXPECT_GT(device.online.coverage, 0.5) << to_table(*report);
  ASSERT_TRUE(device.online.mean_trans_m) << to_table(*report);
  EXPECT_LT(*device.online.mean_trans_m, 0.1);
  EXPECT_LT(*device.online.mean_rot_deg, 3);
  EXPECT_GE(device.spots.verified, 3u);
  EXPECT_EQ(device.spots.verified_wrong, 0u);
  EXPECT_TRUE(report->run.skipped.empty());
}

TEST_F(Lockstep, TellsTheClientsShareOfTheCpu) {
  const auto report = replay(options("cpu"));
  ASSERT_TRUE(report) << report.error().error.message;
  ASSERT_TRUE(report->run.client_cpu_s.contains("device0"));
  EXPECT_GT(report->run.client_cpu_s.at("device0"), 0);
  EXPECT_LT(report->run.client_cpu_s.at("device0"),
            report->run.wall_s);  // one thread, and the server's work beside it
  EXPECT_THAT(to_table(*report), testing::HasSubstr("ms per localized second"));
  EXPECT_THAT(to_json(*report), testing::HasSubstr("client_cpu_ms_per_localized_s"));
}

TEST_F(Lockstep, TheSameSeedGivesTheSameAnswersBitByBit) {
  ASSERT_TRUE(replay(options("first")));
  ASSERT_TRUE(replay(options("second")));
  const fs::path first = options("first").out / "device0", second = options("second").out / "device0";
  for (const char* name : {"online.tum", "trajectory.tum"}) {
    EXPECT_FALSE(text_of(first / name).empty());
    EXPECT_EQ(text_of(first / name), text_of(second / name)) << name;
  }
  for (const char* name : {"spots.csv", "local.csv"})
    EXPECT_EQ(without_latency(first / name), without_latency(second / name)) << name;
}

TEST_F(Lockstep, SavedAnswersAreGivenAgainToTheDigit) {
  ReplayOptions saving = options("saving");
  const fs::path kept = folder_->path() / "kept";
  saving.save_answers = kept.string() + ":all";
  const auto report = replay(saving);
  ASSERT_TRUE(report) << report.error().error.message;
  std::size_t answers = 0;
  for (const auto& entry : fs::directory_iterator(kept)) {
    const auto saved = answers::read_answer(entry.path());
    ASSERT_TRUE(saved) << saved.error().message;
    EXPECT_THAT(answers::explain(*saved).differences, testing::IsEmpty()) << entry.path();
    ++answers;
  }
  EXPECT_EQ(answers, report->devices[0].spots.n);
  ASSERT_TRUE(replay(options("not_saving")));
  EXPECT_EQ(without_latency(saving.out / "device0/spots.csv"),
            without_latency(options("not_saving").out / "device0/spots.csv"))
      << "saving changes no answer";
}

TEST_F(Lockstep, WrongAnswersAreThoseThatTheTruthContradicts) {
  const fs::path moved = folder_->path() / "moved_truth";
  fs::copy(folder_->path() / "rec", moved, fs::copy_options::recursive);
  const auto device = open_recording(moved)->devices[0];
  auto truth = *read_ground_truth(device);
  for (StampedPose& pose : truth) pose.T_map_sensor.translation().x() += 1;
  ASSERT_TRUE(write_tum(device.folder / "groundtruth.tum", truth));
  ReplayOptions saving = options("wrong");
  const fs::path kept = folder_->path() / "kept_wrong";
  saving.save_answers = kept.string() + ":wrong";
  const auto right = replay(saving);
  ASSERT_TRUE(right) << right.error().error.message;
  EXPECT_TRUE(fs::is_empty(kept));
  saving.recording = moved;
  const auto report = replay(saving);
  ASSERT_TRUE(report) << report.error().error.message;
  const auto files = std::distance(fs::directory_iterator(kept), fs::directory_iterator());
  EXPECT_GT(files, 0);
  EXPECT_EQ(static_cast<std::size_t>(files), report->devices[0].spots.verified_wrong);
}

TEST_F(Lockstep, EveryFrameAndEveryRequestHasARow) {
  const auto report = replay(options("rows"));
  ASSERT_TRUE(report) << report.error().error.message;
  const auto local = Csv::read(options("rows").out / "device0/local.csv");
  const auto spots = Csv::read(options("rows").out / "device0/spots.csv");
  ASSERT_TRUE(local && spots);
  EXPECT_EQ(local->rows(), report->run.device_frames);
  EXPECT_GE(spots->rows(), 5u);  // one at once, then one every 800 ms
  for (std::size_t row = 0; row < spots->rows(); ++row) {
    EXPECT_TRUE(spots->integer(row, "stamp_ns"));
    EXPECT_FALSE(spots->text(row, "status").empty());
    EXPECT_NE(spots->text(row, "reason"), "no_answer");
  }
}

TEST_F(Lockstep, AnAnswerNeverMovesAnEarlierPose) {
  // Whatever comes later in a recording, the online poses up to then are the same: cut it and compare.
  ASSERT_TRUE(replay(options("whole")));
  const fs::path cut = folder_->path() / "cut";
  fs::copy(folder_->path() / "rec", cut, fs::copy_options::recursive);
  fs::remove(cut / "devices/device0/groundtruth.tum");
  const auto whole = open_for_replay(options("whole"));
  ASSERT_TRUE(whole);
  const StampNs end_ns = whole->devices[0].depth.front().stamp_ns + from_seconds(3);
  for (const auto& entry : fs::recursive_directory_iterator(cut))
    if (entry.path().extension() == ".png" && std::stoll(entry.path().stem()) > end_ns)
      fs::remove(entry.path());
  ReplayOptions shorter = options("shorter");
  shorter.recording = cut;
  const auto report = replay(shorter);
  ASSERT_TRUE(report) << report.error().error.message;
  const std::string online = text_of(shorter.out / "device0/online.tum");
  EXPECT_GT(std::count(online.begin(), online.end(), '\n'), 10);
  EXPECT_EQ(text_of(options("whole").out / "device0/online.tum").substr(0, online.size()), online);
}

TEST_F(Lockstep, ColdRequestsAreAnsweredToo) {
  ReplayOptions cold = options("cold");
  cold.cold = true;
  const auto report = replay(cold);
  ASSERT_TRUE(report) << report.error().error.message;
  EXPECT_GE(report->devices[0].spots.n, 5u);
  EXPECT_EQ(report->devices[0].spots.verified_wrong, 0u);
  ASSERT_GT(report->devices[0].spots.verified, 0u);
  EXPECT_GT(report->devices[0].online.coverage, 0.1) << "a verified answer gives poses, also without a history";
}

}  // namespace
}  // namespace liloc::replay
