#include "server/view/painter.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "common/codec/codec.hpp"
#include "server/view/tests/points.hpp"
#include "server/view/tests/source.hpp"

namespace liloc::view {
namespace {

using namespace std::chrono_literals;

class Painting : public testing::Test {
 protected:
  using Parts = std::set<std::string>;
  /// The parts that are new.
  Parts painted(Painter::Time at) {
    painter.paint(at);
    Parts parts;
    while (const auto message = board.next(seen)) {
      if (message->binary)
        parts.insert(message->bytes[0] == 1 ? "room" : "moving");
      else
        parts.insert(nlohmann::json::parse(message->bytes)["part"]);
    }
    return parts;
  }
  const Parts all{"site", "now", "moving", "room", "trails", "charts", "log"};
  test::Place place;
  Board board;
  Board::Seen seen;
  Painter painter{place.source(), board};
  const Painter::Time start = std::chrono::steady_clock::now();
};

TEST_F(Painting, TellsAllAtFirstThenOnlyWhatChanged) {
  place.frame();
  EXPECT_EQ(painted(start), all);
  EXPECT_EQ(painted(start + 200ms), (Parts{"now"}));
  place.frame();
  EXPECT_EQ(painted(start + 400ms), (Parts{"now", "moving"})) << "the wall stands still";
  place.log->add(log::Level::info, "news");
  EXPECT_EQ(painted(start + 1000ms), (Parts{"now", "charts", "log"}));
  EXPECT_EQ(painted(start + 5000ms), (Parts{"now", "trails", "charts"}));
}

TEST_F(Painting, TheRoomIsToldEveryTwoSecondsAtMostAndNeverForgotten) {
  place.frame();
  painted(start);
  for (int i = 0; i < 3; ++i) place.frame(4000);  // the wall is far behind: another room
  EXPECT_FALSE(painted(start + 1900ms).contains("room"));
  place.frame(4000);
  EXPECT_TRUE(painted(start + 2100ms).contains("room"));
}

TEST_F(Painting, BeforeTheFirstFrameThereAreNoPoints) {
  EXPECT_EQ(painted(start), (Parts{"site", "now", "trails", "charts", "log"}));
}

TEST_F(Painting, AfterARestAllIsToldAnew) {
  place.frame();
  painted(start);
  painter.rest();
  EXPECT_EQ(board.next(seen), nullptr);
  Board::Seen late;
  EXPECT_EQ(board.next(late), nullptr) << "what is old is not shown";
  EXPECT_EQ(painted(start + 1h), (Parts{"now", "site", "moving", "room", "trails", "charts", "log"}));
}

TEST_F(Painting, ACloudIsDrawnWhereTheDeviceWasGuessedToBe) {
  SpotRequest request;
  request.client_id = "robot1";
  request.lpc = encode({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}, {}}).value();
  SpotReply reply = refusal(request, Reason::not_found, "");
  place.journal->located(request, reply);
  EXPECT_EQ(painter.scan_of("robot1"), "") << "nobody knows where";
  reply.T_map_sensor = Pose::Identity();
  reply.T_map_sensor->translation().x() = 5;
  place.journal->located(request, reply);
  const auto read = test::read_points(painter.scan_of("robot1"));
  EXPECT_EQ(read.kind, 3);
  ASSERT_EQ(read.points_map.size(), 4U);
  for (const auto& p : read.points_map) EXPECT_GT(p.x(), 4.9F);
  request.lpc.bytes.resize(request.lpc.bytes.size() / 2);
  place.journal->located(request, reply);
  EXPECT_EQ(painter.scan_of("robot1"), "") << "a damaged cloud";
  EXPECT_EQ(painter.scan_of("nobody"), "");
}

}  // namespace
}  // namespace liloc::view
