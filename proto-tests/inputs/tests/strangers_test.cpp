// A stranger in an open domain: what it can write into the logs of a server and of a client.
#include <fstream>
#include <regex>

#include "common/recording/files.hpp"
#include "proto-tests/inputs/stranger.hpp"
#include "proto-tests/inputs/tests/live_site.hpp"

namespace liloc::inputs {
namespace {

/// What a program has written to its log.
struct Written {
  std::size_t bytes = 0, lines = 0, controls = 0;
  std::size_t foreign = 0;  ///< lines that do not begin as the program's own do
};

Written written(const std::filesystem::path& log) {
  const std::string text = read_file(log, 1 << 26).value_or("");
  static const std::regex own(R"(^\d{4}-\d\d-\d\d \d\d:\d\d:\d\d\.\d{3} (debug|info|warning|error) .*)");
  Written all{text.size(), 0, 0, 0};
  std::istringstream in(text);
  for (std::string line; std::getline(in, line); ++all.lines) {
    if (!std::regex_match(line, own)) ++all.foreign;
    for (const char c : line)
      if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) ++all.controls;
    if (line.find("\xc2\x9b") != std::string::npos) ++all.controls;
  }
  return all;
}

TEST_F(LiveSite, AStrangersFloodIsFewLinesWithoutControlCharacters) {
  open(small_site(3, 1));
  if (HasFatalFailure()) return;
  std::vector<std::string> command{LILOC_CLIENT};
  for (const std::string& argument : device(0)) command.push_back(argument);
  const auto client_log = folder_.path() / "client.log", server_log_file = folder_.path() / "server.log";
  auto client = replay::Child::start(command, client_log);
  ASSERT_TRUE(client) << client.error().message;
  const auto verified = [&] { return server_->status()->verified; };
  EXPECT_TRUE(within(30s, [&] { return verified() > 0; }) || !kMeasured) << server_log();
  auto stranger = Stranger::join(domain_, "device0", "ceiling0");
  ASSERT_TRUE(stranger) << stranger.error().message;
  (*stranger)->molest();
  std::this_thread::sleep_for(500ms);  // found by both
  const Written server_before = written(server_log_file), client_before = written(client_log);
  const auto until = std::chrono::steady_clock::now() + 2s;
  for (; std::chrono::steady_clock::now() < until; std::this_thread::sleep_for(5ms)) (*stranger)->molest();
  const int rounds = (*stranger)->rounds();
  EXPECT_GT(rounds, kMeasured ? 50 : 2);
  stranger->reset();
  const auto before = verified();
  EXPECT_TRUE(within(10s, [&] { return verified() > before + 1; }) || !kMeasured)
      << "who was molested is served again";
  EXPECT_TRUE(server_->running() && client->running());
  const Written server = written(server_log_file), of_client = written(client_log);
  RecordProperty("rounds", rounds);
  RecordProperty("server_lines", static_cast<int>(server.lines - server_before.lines));
  RecordProperty("client_lines", static_cast<int>(of_client.lines - client_before.lines));
  // Two windows of five seconds; in each 16 names that come, 16 that go, 16 texts of DDS, a few kinds more.
  EXPECT_LE(server.lines - server_before.lines, 2 * (16 + 16 + 16 + 6)) << server_log();
  EXPECT_LE(server.bytes - server_before.bytes, 20'000U);
  EXPECT_LE(of_client.lines - client_before.lines, 2 * (16 + 6)) << replay::last_lines(client_log, 20);
  EXPECT_LE(of_client.bytes - client_before.bytes, 10'000U);
  for (const Written& log : {server, of_client}) {
    EXPECT_GT(log.lines, 0U);
    EXPECT_EQ(log.controls, 0U);
    EXPECT_EQ(log.foreign, 0U);
  }
}

}  // namespace
}  // namespace liloc::inputs
