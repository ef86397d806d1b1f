#include "client/engine/trace.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>

namespace liloc {
namespace {

using testing::ElementsAre;
using testing::StartsWith;

class Trace : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              fmt::format("liloc_trace_{}_{}", ::getpid(),
                          testing::UnitTest::GetInstance()->current_test_info()->name());
    ASSERT_TRUE(trace_.open(folder_));
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::vector<std::string> lines(const char* name) const {
    std::ifstream file(folder_ / name);
    std::vector<std::string> all;
    for (std::string line; std::getline(file, line);) all.push_back(line);
    return all;
  }
  /// A frame each second; odometry goes along x at 1 m/s.
  FrameResult frame(int second, std::optional<double> map_x, std::uint32_t segment = 0) {
    FrameResult f;
    f.stamp_ns = second * 1'000'000'000LL + 5;
    f.source = PoseSource::icp;
    f.latency_ms = 1.5;
    f.odom_segment = segment;
    f.T_odom_sensor = Pose(Eigen::Translation3d(second, 0, 0));
    if (map_x) f.T_map_sensor = Pose(Eigen::Translation3d(*map_x, 0, 0));
    return f;
  }
  SpotRequest request(std::uint64_t seq, int second) {
    SpotRequest r;
    r.seq = seq;
    r.stamp_ns = second * 1'000'000'000LL + 5;
    return r;
  }
  SpotReply verified(const SpotRequest& request, double shift) {
    SpotReply r;
    r.seq = request.seq;
    r.stamp_ns = request.stamp_ns;
    r.gpc_stamp_ns = 77;
    r.status = SpotStatus::verified;
    r.reason = Reason::confirmed;
    r.T_map_sensor = Pose(Eigen::Translation3d(shift, 0, 0));
    r.T_map_odom = Pose(Eigen::Translation3d(0, shift, 0));
    r.fitness = 0.5;
    r.latency_ms = 12.25;
    return r;
  }

  /// A verified answer that shifts by as many metres as seconds have passed.
  void ask_and_answer(int second, bool late = false) {
    trace_.on_request(request(1, second));
    if (late) trace_.on_timeout(1);
    trace_.on_reply(verified(request(1, second), second));
  }

  std::filesystem::path folder_;
  TraceWriter trace_;
};

TEST_F(Trace, HeadersAreTheContract) {
  EXPECT_EQ(lines("local.csv").front(),
            "stamp_ns,informative,method,converged,latency_ms,tx,ty,tz,qx,qy,qz,qw");
  EXPECT_EQ(
      lines("spots.csv").front(),
      "stamp_ns,gpc_stamp_ns,status,verified,reason,tx,ty,tz,qx,qy,qz,qw,fitness,inlier_rmse_m,overlap,margin,"
      "latency_ms,confidence,advice");
}

TEST_F(Trace, RowsAreThereBeforeTheEnd) {
  ASSERT_TRUE(trace_.on_frame(frame(1, std::nullopt)));
  ASSERT_TRUE(trace_.on_frame(frame(2, 9.0)));
  EXPECT_THAT(lines("local.csv").at(1),
              "1000000005,1,icp,1,1.500,1.000000,0.000000,0.000000,0.000000,0.000000,0.000000,1.000000");
  EXPECT_THAT(lines("online.tum"),
              ElementsAre(StartsWith("#"),
                          "2.000000005 9.000000 0.000000 0.000000 0.000000 0.000000 0.000000 1.000000"));
}

TEST_F(Trace, EveryRequestHasOneRow) {
  const auto answered = request(1, 1), silent = request(2, 2), late = request(3, 3), refused = request(4, 4);
  for (const auto& r : {answered, silent, late, refused}) trace_.on_request(r);
  trace_.on_reply(verified(answered, 4));
  trace_.on_reply(verified(answered, 4));       // once more
  trace_.on_reply(verified(request(9, 9), 4));  // nobody asked
  trace_.on_timeout(3);
  trace_.on_reply(verified(late, 4));
  trace_.on_reply(refusal(refused, Reason::no_gpc, "none"));
  ASSERT_TRUE(trace_.close());
  const auto rows = lines("spots.csv");
  ASSERT_EQ(rows.size(), 5U);
  EXPECT_EQ(rows[1],
            "1000000005,77,verified,1,confirmed,4.000000,0.000000,0.000000,0.000000,0.000000,0.000000,1.000000,"
            "0.5000,0.00000,0.0000,0.0000,12.250,0.00000,none");
  EXPECT_EQ(rows[2], "3000000005,0,refused,0,no_answer,,,,,,,,,,,,,,");
  EXPECT_THAT(rows[3], StartsWith("4000000005,0,refused,0,no_gpc,,,,,,,,"));
  EXPECT_EQ(rows[4], "2000000005,0,refused,0,no_answer,,,,,,,,,,,,,,");
  for (const auto& row : rows) EXPECT_EQ(std::count(row.begin(), row.end(), ','), 18);
}

TEST_F(Trace, TheTrajectoryMixesTheCorrectionsAroundAFrame) {
  for (int s = 1; s <= 6; ++s) {
    ASSERT_TRUE(trace_.on_frame(frame(s, s >= 2 ? std::optional<double>(s) : std::nullopt)));
    if (s == 2 || s == 4) ask_and_answer(s);
  }
  ASSERT_TRUE(trace_.close());
  std::vector<double> y;
  for (const auto& row : lines("trajectory.tum")) {
    double stamp = 0, tx = 0, ty = 0;
    if (std::sscanf(row.c_str(), "%lf %lf %lf", &stamp, &tx, &ty) == 3) y.push_back(ty);
  }
  EXPECT_THAT(y, ElementsAre(2, 3, 4, 4, 4));  // frames 2..6: at, between, at, after, after
}

TEST_F(Trace, ALateAnswerCorrectsAsWell) {
  ASSERT_TRUE(trace_.on_frame(frame(3, 3.0)));
  ask_and_answer(3, true);
  ASSERT_TRUE(trace_.close());
  EXPECT_THAT(lines("trajectory.tum").at(1), StartsWith("3.000000005 3.000000 3.000000 "));
}

TEST_F(Trace, ASegmentWithoutAnAnswerKeepsItsBridge) {
  ask_and_answer(1);
  ASSERT_TRUE(trace_.on_frame(frame(2, 42.0, 1)));
  ASSERT_TRUE(trace_.close());
  EXPECT_THAT(lines("trajectory.tum").at(1), StartsWith("2.000000005 42.000000 "));
}

/// Files may not grow beyond so many bytes, as on a full disk: the write that would is cut short.
class FileLimit {
 public:
  explicit FileLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    signal_before_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    static_cast<void>(std::signal(SIGXFSZ, signal_before_));
  }
  FileLimit(const FileLimit&) = delete;
  FileLimit& operator=(const FileLimit&) = delete;

 private:
  rlimit before_{};
  void (*signal_before_)(int) = nullptr;
};

TEST_F(Trace, AFullDiskIsToldAtOnceAndLeavesWholeRows) {
  ask_and_answer(1);
  std::optional<int> told;
  Status closed;
  {
    const FileLimit full(2000);
    for (int s = 1; s <= 60; ++s)
      if (!trace_.on_frame(frame(s, s)) && !told) told = s;
    closed = trace_.close();
  }
  ASSERT_TRUE(told);
  EXPECT_LT(*told, 40);  // 50 bytes a row and more
  ASSERT_FALSE(closed);
  EXPECT_THAT(closed.error().message, testing::HasSubstr("File too large"));
  const std::string row = lines("local.csv").back();
  EXPECT_EQ(std::count(row.begin(), row.end(), ','), 11) << row;
  EXPECT_GT(lines("trajectory.tum").size(), 10U);
  const std::string last = lines("trajectory.tum").back();
  EXPECT_EQ(std::count(last.begin(), last.end(), ' '), 7) << last;
}

TEST_F(Trace, TheTrajectoryIsWrittenWhileItRuns) {
  ask_and_answer(1);
  for (int s = 1; s <= 60; ++s) ASSERT_TRUE(trace_.on_frame(frame(s, s)));
  EXPECT_GE(lines("trajectory.tum").size(), 50U);
  ASSERT_TRUE(trace_.close());
  EXPECT_EQ(lines("trajectory.tum").size(), 61U);
}

TEST(TraceWriter, AFolderThatCannotBeMadeIsAnError) {
  TraceWriter trace;
  const auto opened = trace.open("/proc/liloc");
  ASSERT_FALSE(opened);
  EXPECT_THAT(opened.error().message, testing::HasSubstr("/proc/liloc"));
}

}  // namespace
}  // namespace liloc
