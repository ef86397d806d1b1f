#include "server/view/board.hpp"

#include <gtest/gtest.h>

namespace liloc::view {
namespace {

std::string next(const Board& board, Board::Seen& seen) {
  const auto message = board.next(seen);
  return message ? message->bytes : "";
}

TEST(Board, ShowsEachPartOnce) {
  Board board;
  Board::Seen seen;
  EXPECT_EQ(next(board, seen), "");
  board.put(Part::now, {"n1"});
  board.put(Part::log, {"l1"});
  EXPECT_EQ(next(board, seen), "n1");
  EXPECT_EQ(next(board, seen), "l1");
  EXPECT_EQ(next(board, seen), "");
}

TEST(Board, ASlowViewerMissesWhatWasReplaced) {
  Board board;
  Board::Seen slow, quick;
  for (int i = 0; i < 10; ++i) {
    board.put(Part::now, {"n" + std::to_string(i)});
    EXPECT_EQ(next(board, quick), "n" + std::to_string(i));
  }
  EXPECT_EQ(next(board, slow), "n9");
  EXPECT_EQ(next(board, slow), "");
}

TEST(Board, ASlowViewerGetsEachPartInTurn) {
  Board board;
  Board::Seen seen;
  std::string got;
  for (int i = 0; i < 6; ++i) {
    board.put(Part::now, {"n"});
    board.put(Part::moving, {"m", true});
    board.put(Part::room, {"r", true});
    got += next(board, seen);
  }
  EXPECT_EQ(got, "nmrnmr");
}

TEST(Board, ClearedPartsAreNotShownUntilTheyAreNew) {
  Board board;
  Board::Seen seen;
  board.put(Part::now, {"old"});
  board.clear();
  EXPECT_EQ(next(board, seen), "");
  board.put(Part::now, {"new"});
  EXPECT_EQ(next(board, seen), "new");
}

}  // namespace
}  // namespace liloc::view
