#include "server/app/json_line.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace liloc {
namespace {

using namespace std::chrono_literals;

TEST(JsonLine, IsOneObjectOnOneLineWhateverTheMessageHolds) {
  const std::chrono::system_clock::time_point at{1'700'000'000s + 42ms};
  EXPECT_EQ(json_line(at, log::Level::warning, "ceiling0: silent"),
            R"({"time":"2023-11-14T22:13:20.042Z","level":"warning","message":"ceiling0: silent"})");
  const std::string odd = json_line(at, log::Level::error, "a \"b\"\n\x1b[31m \xff");
  EXPECT_EQ(odd.find_first_of("\n\x1b\xff"), std::string::npos);
  EXPECT_EQ(nlohmann::json::parse(odd)["message"], "a \"b\"\n\x1b[31m \xEF\xBF\xBD");
}

}  // namespace
}  // namespace liloc
