#include "proto-tests/soak/servers.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <fstream>
#include <thread>

#include "proto-tests/replay/tests/temp_folder.hpp"

namespace liloc::soak {
namespace {

namespace fs = std::filesystem;

/// A standby that is a shell, restarted every 15 s of a run of 100 s.
class StandbyTest : public testing::Test {
 protected:
  static SoakOptions options() {
    SoakOptions options;
    options.seconds = 100;
    options.restart_s = 15;
    return options;
  }
  /// What a standby tells that answered somebody.
  void answer() {
    wire::ServerStatus status;
    status.server_id = "liloc-standby";
    status.answered = 3;
    board_.note(status);
  }
  void tend(double now_s) {
    const Status tended = standby_.tend(now_s, board_);
    ASSERT_TRUE(tended) << tended.error().message;
  }
  [[nodiscard]] std::string log(const std::string& name) const {
    std::ifstream in(folder_.path() / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  replay::TempFolder folder_;
  StatusBoard board_;
  Standby standby_{options(), {"/bin/sh", "-c", "echo $$; exec sleep 600"}, folder_.path()};
};

TEST_F(StandbyTest, OneThatAnswersIsNotSilentAndOneThatEndsAtOnceHadNoTime) {
  tend(0);
  answer();
  tend(15);
  EXPECT_EQ(standby_.restarts(), 1);
  tend(17);
  ASSERT_TRUE(standby_.stop(26, board_));
  EXPECT_EQ(standby_.silent(), 0);
  EXPECT_FALSE(fs::exists(folder_.path() / "standby-silent.log"));
}

// What the one before had told stood for the one after it.
TEST_F(StandbyTest, EachRestartedOneHasToAnswerItself) {
  tend(0);
  answer();
  tend(15);
  tend(17);
  tend(30);
  EXPECT_EQ(standby_.restarts(), 2);
  EXPECT_EQ(standby_.silent(), 1) << "the second told nothing";
  EXPECT_TRUE(fs::exists(folder_.path() / "standby-silent.log"));
}

TEST_F(StandbyTest, TheLastOneIsJudgedToo) {
  tend(0);
  answer();
  tend(15);
  tend(17);
  ASSERT_TRUE(standby_.stop(29, board_));
  EXPECT_EQ(standby_.silent(), 1);
}

TEST_F(StandbyTest, TheLogOfTheOneBeforeIsStillThere) {
  const auto written = [&](const char* name) {
    for (int i = 0; i < 500 && log(name).empty(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return log(name);
  };
  tend(0);
  const std::string first = written("standby0.log");
  tend(15);
  tend(17);
  const std::string second = written("standby1.log");
  EXPECT_NE(first, second);
  EXPECT_EQ(log("standby0.log"), first);
}

}  // namespace
}  // namespace liloc::soak
