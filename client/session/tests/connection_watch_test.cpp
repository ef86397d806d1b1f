#include "client/session/connection_watch.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/log.hpp"

namespace liloc {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class Watch : public testing::Test {
 protected:
  Watch() {
    log::set_sink([this](log::Level, std::string_view line) { lines_.emplace_back(line); });
  }
  ~Watch() override { log::set_sink({}); }
  /// Looks each second from `from_s` on.
  void look(int from_s, int to_s, bool connected) {
    for (int s = from_s; s <= to_s; ++s) watch_.look(stats_, connected, begin_ + std::chrono::seconds(s));
  }
  [[nodiscard]] int told(const std::string& what) const {
    return static_cast<int>(std::count_if(lines_.begin(), lines_.end(), [&](const std::string& line) {
      return line.find(what) != std::string::npos;
    }));
  }

  const ConnectionWatch::Time begin_ = std::chrono::steady_clock::now();
  ConnectionWatch watch_{{"robot1", "/camera/depth", "domain 7, interface eth0"}, begin_};
  SessionStats stats_;
  std::vector<std::string> lines_;
};

TEST_F(Watch, ASilentTopicIsNamedOnceInTenSeconds) {
  look(0, 4, true);
  EXPECT_EQ(watch_.no_frames(), "");
  look(5, 24, true);
  EXPECT_THAT(watch_.no_frames(), AllOf(HasSubstr("/camera/depth"), HasSubstr("domain 7, interface eth0")));
  EXPECT_EQ(told("/camera/depth"), 2);
  ++stats_.frames_refused;  // wrong, but there
  look(25, 25, true);
  EXPECT_EQ(watch_.no_frames(), "");
}

TEST_F(Watch, AMissingServerIsToldWithTheNetwork) {
  look(0, 34, false);
  EXPECT_THAT(watch_.no_answers(), AllOf(HasSubstr("no server"), HasSubstr("domain 7, interface eth0")));
  EXPECT_EQ(told("no server"), 3);
  look(35, 35, true);
  EXPECT_EQ(watch_.no_answers(), "");
  EXPECT_EQ(told("the server is there"), 1);
}

TEST_F(Watch, AServerThatComesAndGoesIsToldOnceInFiveSeconds) {
  for (int s = 0; s < 20; ++s) look(s, s, s % 2 == 0);
  EXPECT_THAT(told("the server is"), testing::AllOf(testing::Ge(3), testing::Le(5)));
}

TEST_F(Watch, WhoHearsALineMayAsk) {
  int asked = 0;
  log::set_sink([&](log::Level, std::string_view) {
    ++asked;
    static_cast<void>(watch_.no_frames() + watch_.no_answers());
  });
  look(0, 6, true);
  EXPECT_EQ(asked, 2);  // the server is there, no frames
}

TEST_F(Watch, RefusalsAreToldWithTheRemedy) {
  stats_.refusals_in_row = 2;
  stats_.newest_refusal = Reason::no_gpc;
  look(0, 3, true);
  EXPECT_EQ(watch_.no_answers(), "");
  stats_.refusals_in_row = 3;
  look(4, 23, true);
  EXPECT_THAT(watch_.no_answers(), AllOf(HasSubstr("no_gpc"), HasSubstr("doctor")));
  EXPECT_EQ(told("refuses every request"), 2);
}

}  // namespace
}  // namespace liloc
