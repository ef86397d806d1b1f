#include "server/view/painter.hpp"

#include <gtest/gtest.h>

#include <map>
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
  std::string drawn(const std::string& client_id) {
    const auto message = painter.scan_of(client_id);
    return message ? *message : "";
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
  EXPECT_TRUE(painted(start + 2100ms).contains("room")) << "though no frame came since";
}

TEST_F(Painting, PointsThatTheServerNoLongerHasGo) {
  Source source = place.source();
  bool has_frames = true;
  source.moment = [&, newest = source.moment] { return has_frames ? newest() : nullptr; };
  Painter own(source, board);
  const auto points_at = [&](Painter::Time at) {
    own.paint(at);
    std::map<int, std::size_t> points;
    while (const auto message = board.next(seen))
      if (message->binary) {
        const auto read = test::read_points(message->bytes);
        points[read.kind] = read.points_map.size();
      }
    return points;
  };
  constexpr int kRoom = 1, kMoving = 2;
  place.frame();
  EXPECT_GT(points_at(start)[kRoom], 100U);
  has_frames = false;
  EXPECT_EQ(points_at(start + 200ms), (std::map<int, std::size_t>{{kRoom, 0}, {kMoving, 0}}));
  EXPECT_TRUE(points_at(start + 400ms).empty()) << "told once";
  has_frames = true;
  EXPECT_GT(points_at(start + 600ms)[kRoom], 100U) << "nobody waits for the next turn before an empty room";
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
  EXPECT_EQ(drawn("robot1"), "") << "nobody knows where";
  reply.T_map_sensor = Pose::Identity();
  reply.T_map_sensor->translation().x() = 5;
  place.journal->located(request, reply);
  const auto read = test::read_points(drawn("robot1"));
  EXPECT_EQ(read.kind, 3);
  ASSERT_EQ(read.points_map.size(), 4U);
  for (const auto& p : read.points_map) EXPECT_GT(p.x(), 4.9F);
  request.lpc.bytes.resize(request.lpc.bytes.size() / 2);
  place.journal->located(request, reply);
  EXPECT_EQ(drawn("robot1"), "") << "a damaged cloud";
  EXPECT_EQ(painter.scan_of("nobody"), nullptr);
}

TEST_F(Painting, ACloudIsDrawnOnceForAllWhoAskForIt) {
  const auto lost = [&](const std::string& id) {
    SpotRequest request;
    request.client_id = id;
    request.lpc = encode({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}, {}}).value();
    SpotReply reply = refusal(request, Reason::not_found, "");
    reply.T_map_sensor = Pose::Identity();
    place.journal->located(request, reply);
  };
  lost("robot1");
  lost("robot2");
  const auto first = painter.scan_of("robot1");
  EXPECT_NE(painter.scan_of("robot2"), first);
  EXPECT_EQ(painter.scan_of("robot1"), first);
  lost("robot1");
  EXPECT_NE(painter.scan_of("robot1"), first) << "the next answer has another cloud";
  for (int i = 0; i < 20; ++i) {
    lost("r" + std::to_string(i));
    static_cast<void>(painter.scan_of("r" + std::to_string(i)));
  }
  EXPECT_EQ(first.use_count(), 1) << "what is old is not kept";
}

}  // namespace
}  // namespace liloc::view
