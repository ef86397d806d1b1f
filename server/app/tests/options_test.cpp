#include "server/app/options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace liloc {
namespace {

using testing::HasSubstr;

struct Parsed {
  Result<ServerOptions> options = fail("not parsed");
  int exit_code = -1;
};

Parsed parse(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"liloc-server", "--site", "hall/site.json"});
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  Parsed parsed;
  parsed.options = parse_arguments(static_cast<int>(argv.size()), argv.data(), parsed.exit_code);
  return parsed;
}

TEST(ServerOptions, DefaultsAreThoseOfThePartsAndTheStateLiesBesideTheSite) {
  const auto parsed = parse({});
  ASSERT_TRUE(parsed.options) << parsed.options.error().message;
  EXPECT_EQ(parsed.exit_code, 0);
  EXPECT_EQ(parsed.options->site_file, "hall/site.json");
  EXPECT_EQ(parsed.options->state_file, "hall/site.state.json");
  EXPECT_EQ(parsed.options->seat.role, wire::Role::server);
  EXPECT_EQ(parsed.options->service.hold, std::chrono::milliseconds(100));
  EXPECT_DOUBLE_EQ(parsed.options->localizer.risk, LocalizerOptions{}.risk);
  EXPECT_FALSE(parsed.options->metrics || parsed.options->page || parsed.options->save_answers);
}

TEST(ServerOptions, ValuesReachThePartThatTheyAreFor) {
  const auto parsed = parse({"--domain",       "7",       "--workers", "3",     "--queue",      "9",
                             "--hold-ms",      "250",     "--risk",    "0.01",  "--voxel",      "0.08",
                             "--server-id",    "edge2",   "--metrics", "9464",  "--log-format", "json",
                             "--save-answers", "out:all", "--icp",     "point", "--log-level",  "error"});
  ASSERT_TRUE(parsed.options) << parsed.options.error().message;
  const ServerOptions& o = *parsed.options;
  EXPECT_EQ(o.seat.domain, 7);
  EXPECT_EQ(o.service.workers, 3);
  EXPECT_EQ(o.service.queue, 9U);
  EXPECT_EQ(o.service.hold, std::chrono::milliseconds(250));
  EXPECT_DOUBLE_EQ(o.localizer.risk, 0.01);
  EXPECT_DOUBLE_EQ(o.localizer.voxel_size_m, 0.08);
  EXPECT_EQ(o.service.server_id, "edge2");
  EXPECT_EQ(o.localizer.server_id, "edge2");
  ASSERT_TRUE(o.metrics);
  EXPECT_EQ(o.metrics->port, 9464);
  EXPECT_TRUE(o.log_json);
  EXPECT_EQ(o.log_level, log::Level::error);
  ASSERT_TRUE(o.save_answers);
  EXPECT_EQ(o.save_answers->which, answers::Which::all);
  EXPECT_EQ(o.localizer.icp, icp_from("point").value());
}

TEST(ServerOptions, AStandbyHasItsOwnPortNameAndState) {
  const auto parsed = parse({"--standby", "--server-id", "edge"});
  ASSERT_TRUE(parsed.options);
  EXPECT_EQ(parsed.options->seat.role, wire::Role::standby);
  EXPECT_EQ(parsed.options->service.server_id, "edge") << "as it was given";
  const auto unnamed = parse({"--standby"});
  ASSERT_TRUE(unnamed.options);
  EXPECT_EQ(unnamed.options->service.server_id, ServiceOptions{}.server_id + "-standby");
  EXPECT_NE(unnamed.options->state_file, parse({}).options->state_file);
  EXPECT_EQ(unnamed.options->localizer.server_id, unnamed.options->service.server_id);
}

TEST(ServerOptions, TheStateMayBeElsewhereOrNowhere) {
  EXPECT_EQ(parse({"--state", "none"}).options->state_file, "");
  EXPECT_EQ(parse({"--state", "x/y.json", "--standby"}).options->state_file, "x/y.json");
}

TEST(ServerOptions, WhatIsWrongIsNamedWithExitCodeTwo) {
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"--risk", "0.5"}, "--risk"},
      {{"--hold-ms", "1001"}, "--hold-ms"},
      {{"--seed", "-1"}, "--seed"},
      {{"--threads", "0"}, "--threads"},
      {{"--max-clients", "5000"}, "--max-clients"},
      {{"--verify", "tracks", "--method", "paper"}, "--verify"},
      {{"--features", "learned"}, "convert_fcgf.py"},
      {{"--features", "learned", "--weights", "/none"}, "--weights: /none"},
      {{"--weights", "/none"}, "--features learned"},
      {{"--web-token", "file"}, "--web-token goes with --web"},
      {{"--save-answers", "out:wrong"}, "--save-answers"},
      {{"--interface", "a b"}, "--interface"}};
  for (const auto& [arguments, says] : cases) {
    const auto parsed = parse(arguments);
    ASSERT_FALSE(parsed.options) << says;
    EXPECT_EQ(parsed.exit_code, 2);
    EXPECT_THAT(parsed.options.error().message, HasSubstr(says));
  }
}

}  // namespace
}  // namespace liloc
